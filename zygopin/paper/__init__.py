"""The paper recomputed: its figures, its statements, and where its print slips."""
