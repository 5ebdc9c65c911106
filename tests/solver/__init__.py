"""hydro2d/solver: the simulation and its measurements."""
