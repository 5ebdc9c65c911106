"""hydro2d/deck: the contents of decks, and messages about them."""
