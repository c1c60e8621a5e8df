"""Footage on disk: clips of every kind, their frames and when they were taken."""
