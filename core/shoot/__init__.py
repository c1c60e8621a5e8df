"""Shoots: many takes that share a description."""
