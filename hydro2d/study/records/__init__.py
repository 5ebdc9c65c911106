"""What the runs of a study left: the study directory, a record and a row of every run, experiments next to them."""
