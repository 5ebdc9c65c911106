"""The scalar functions of hydro2d.physics, one at a time, as Python: other tests compare the compiled ones with them."""
