"""One run of the method in memory: its choices, its start, its cycle, and measurements of a rod in a target."""
