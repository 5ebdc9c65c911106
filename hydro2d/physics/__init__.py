"""What happens in one cell, at one vertex or through one face: scalar functions, each with its equation and its source."""
