"""Edges of the mesh: ghost cells, constraints on vertices, flow through an edge, and its sink in the audit.

There is one kind per file, with the members of `base.Edge`. A new one is a file in this folder and its class in ``KINDS``
of `registry`.
"""
