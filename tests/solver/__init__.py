"""hydro2d/solver: the simulation and what is measured in it."""
