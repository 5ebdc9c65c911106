"""Kernels for what stands between the phases of a step: books, the time step, the active box, a mesh that travels."""
