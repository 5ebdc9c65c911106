"""Sources of energy and momentum, one kind at a time."""
