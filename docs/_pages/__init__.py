"""Builders of reference pages that take more than a table: deck keys, materials, commands, the Python interface."""
