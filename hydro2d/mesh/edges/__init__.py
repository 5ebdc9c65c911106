"""Edges of the mesh: what lies beyond one, what holds its vertices, what flows through it, and where the audit books it.

One kind per file, which `base.Edge` says what it must have. A new one is a file in this folder and its class in ``KINDS`` of
`registry`.
"""
