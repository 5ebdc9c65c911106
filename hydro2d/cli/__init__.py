"""The command `hydro2d`."""
