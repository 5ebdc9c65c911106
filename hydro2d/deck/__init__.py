"""The input deck: strict TOML in, a frozen and validated Deck in SI units out."""
