"""The mesh and its fields: the table of fields, the grid, the state, sums over it."""
