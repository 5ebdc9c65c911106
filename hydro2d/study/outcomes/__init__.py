"""Outcomes of a search for a transition, one per file: the two or three ways in which a run can end, and their rule."""
