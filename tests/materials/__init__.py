"""hydro2d/materials: the library, and models from outside."""
