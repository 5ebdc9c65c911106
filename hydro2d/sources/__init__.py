"""Sources: what adds energy to a body by time and place, one kind per file.

A kind is a section of the deck, a table of [[source]], with what it does: `base.Source` says what a kind must have. A new one
is a file in this folder and its class in ``KINDS`` of `registry`.
"""
