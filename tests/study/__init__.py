"""Studies: files, cases, directories, sweeps."""
