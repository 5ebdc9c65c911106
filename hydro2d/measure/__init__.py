"""What a simulation is found to have done: measurements, each with its declared results, and what makes a run trusted."""
