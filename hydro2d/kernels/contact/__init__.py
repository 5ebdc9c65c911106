"""Contact of groups of bodies that slide on one another: geometry, velocities of the vertices, volumes."""
