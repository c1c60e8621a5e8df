"""Footage on disk: clips of every kind, their frames and times, and small pictures of them."""
