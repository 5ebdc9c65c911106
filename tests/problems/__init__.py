"""The programs and results next to the decks in problems."""
