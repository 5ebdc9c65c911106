"""One run of the method in memory: its choices, its start, its cycle, and what one measures of a rod in a target."""
