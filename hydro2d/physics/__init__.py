"""Physics of one cell, one vertex or one face: scalar functions, each with its equation and its source."""
