"""A run as a process: its directory, its progress, its provenance; checks and timings of decks."""
