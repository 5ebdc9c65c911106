"""A run as a process: its directory, its progress, where it comes from; checks and timings of decks."""
