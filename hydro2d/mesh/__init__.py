"""The mesh and what stands on it: the table of fields, the grid, the state, sums over it."""
