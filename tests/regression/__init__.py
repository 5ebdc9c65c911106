"""Shipped decks, shortened, and what must never change."""
