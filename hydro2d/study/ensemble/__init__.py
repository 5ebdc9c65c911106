"""Statistics of members and meshes, and all that a report is made of."""
