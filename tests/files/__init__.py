"""hydro2d/files: whole files, locks, checksums, strange files."""
