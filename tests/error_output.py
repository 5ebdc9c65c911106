"""The error output of commands, without the lines on the compilation of kernels."""

#: how a line begins that says how far the compilation of kernels is; on a slow machine it comes whenever one is compiled
MOVING = ("compiling kernels: ", "compiled kernels: ")


def lines(error_output: str) -> list[str]:
    """The lines of an error output without those on the compilation of kernels."""
    return [line for line in error_output.splitlines() if not line.startswith(MOVING)]
