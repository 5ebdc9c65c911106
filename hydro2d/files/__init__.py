"""Files: whole or absent, locked, with checksums, plain files only; TOML and the line of a key; the shipped files."""
