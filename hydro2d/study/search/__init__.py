"""Searches for a transition, by bisection or by shots whose outcome is partly chance."""
