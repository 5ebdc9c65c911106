"""Models of strength and failure, one at a time."""
