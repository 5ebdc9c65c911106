"""The error output of commands, without the lines about the compilation of kernels."""

#: beginning of a line that reports progress of the compilation; on a slow machine it appears whenever a kernel is compiled
MOVING = ("compiling kernels: ", "compiled kernels: ")


def lines(error_output: str) -> list[str]:
    """The lines of an error output without those about the compilation of kernels."""
    return [line for line in error_output.splitlines() if not line.startswith(MOVING)]
