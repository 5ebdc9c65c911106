"""The output of a run: quantities, histories, restart files, VTK."""
