"""The scalar functions of hydro2d.physics, one at a time, as Python: the compiled ones are held against it elsewhere."""
