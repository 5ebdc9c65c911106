"""hydro2d/results: what is read back from runs, and drawn."""
