"""What `scripts/benchmark` measures: zygopin and its peers on the same work."""
