"""hydro2d/analytic: the command `hydro2d model`, and curves of flow stress."""
