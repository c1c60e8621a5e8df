"""Kinds of evidence and belief, one a file: its model with Jacobians, and the term of the cost."""
