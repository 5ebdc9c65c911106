"""One phase of the cycle per file: plain arrays in, plain arrays out."""

import hydro2d.kernels.names  # noqa: F401  (without which no kernel can be defined)
