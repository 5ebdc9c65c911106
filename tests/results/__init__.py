"""hydro2d/results: reading and drawing of runs."""
