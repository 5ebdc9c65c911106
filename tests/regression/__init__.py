"""Shipped decks, shortened, and results that must never change."""
