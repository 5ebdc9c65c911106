"""What a study asks for: its file, its cases, their members, velocities and meshes."""
