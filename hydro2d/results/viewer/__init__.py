"""The page of `hydro2d view`: one HTML file with the dumps and history of one or two runs and the program that shows them."""
