"""The plan of a study: its file, its cases, their members, velocities and meshes."""
