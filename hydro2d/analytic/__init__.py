"""The analytic penetration models, applied to materials and decks and compared with experiments and runs."""
