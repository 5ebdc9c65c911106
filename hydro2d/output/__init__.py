"""What a run writes: quantities, histories, restart files, VTK."""
