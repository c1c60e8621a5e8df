"""Blender data to core data and back: no operators, no panels, no user interface."""
