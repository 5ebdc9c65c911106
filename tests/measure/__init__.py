"""hydro2d/measure: what a simulation has done, and whether it is trusted."""
