"""What `scripts/differential` compares: independent routes on random input."""
