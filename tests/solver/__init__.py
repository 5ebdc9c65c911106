"""hydro2d/solver: the simulation."""
