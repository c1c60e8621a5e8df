"""Shoots: many takes that inherit from one description; their discovery, check and outcomes."""
