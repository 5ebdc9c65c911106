"""The page of `hydro2d view`: one HTML file with the dumps and the history of one or two runs, and what shows them."""
