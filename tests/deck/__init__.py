"""hydro2d/deck: what decks may say, and what is said of them."""
