"""Results of the runs of a study: the study directory, a record and a row of every run, experiments next to them."""
