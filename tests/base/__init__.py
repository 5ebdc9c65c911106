"""hydro2d/base: quantities, parameters, messages, child processes, Python text as a tree."""
