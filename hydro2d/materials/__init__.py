"""Named materials: the library, and the rows of numbers that the kernels take."""
