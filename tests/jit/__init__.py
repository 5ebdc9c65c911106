"""hydro2d/jit: compilation, its cache, choice among models, and the barrier."""
