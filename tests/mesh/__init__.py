"""hydro2d/mesh: the table of fields, and the state."""
