"""hydro2d/results/viewer: the page of `hydro2d view`."""
