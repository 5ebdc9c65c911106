"""The kernels of the step, and the phases that call them: functions of arrays that are passed by name (`names`)."""

import hydro2d.kernels.names  # noqa: F401  (without which no kernel can be defined)
