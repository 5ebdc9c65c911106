"""Shapes of bodies, one per file: the keys of its table in a deck, its outline, and its part in a shot."""
