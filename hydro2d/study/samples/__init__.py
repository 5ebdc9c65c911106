"""Samples of uncertain inputs: what the results are, which inputs decide them, and how sure that is."""
