"""Noses of rods, one kind per file: the keys that give its size, and its profile. Decks and analytic models share them."""
