"""The runs of a study: which come next, who makes them, and how far they are."""
