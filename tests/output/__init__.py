"""hydro2d/output: histories, dumps and restart files."""
