"""Sources of energy, one kind at a time."""
