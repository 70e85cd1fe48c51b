"""One module for each tool: a class `Robot` that answers for one file."""
