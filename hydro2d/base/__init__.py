"""Foundations that know nothing of decks or physics: quantities with units, keys, declared parameters, messages, processes."""
