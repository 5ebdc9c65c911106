"""The programs and results that lie beside the decks in problems."""
