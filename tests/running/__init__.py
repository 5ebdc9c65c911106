"""hydro2d/running: runs, checks before them, compilation, threads, and progress."""
