"""Studies: files, cases, directories, sweeps, reports."""
