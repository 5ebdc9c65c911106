"""The analytic penetration models, set beside materials, decks, experiments and runs."""
