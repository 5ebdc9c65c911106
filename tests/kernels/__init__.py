"""The loops over the mesh, one at a time."""
