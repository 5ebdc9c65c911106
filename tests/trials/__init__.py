"""Trials: spoiled and changed decks, spoiled studies, settings and run directories, stopped processes, by the hundred.

Each suite has a short version, which every run of the tests includes, and a long one, marked slow, that prints its count:
``python -m pytest tests/trials -m slow``. A seed determines what is spoiled, and how.
"""
