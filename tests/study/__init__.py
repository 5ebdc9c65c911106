"""Studies and their reports."""
