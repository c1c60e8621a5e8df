"""The border between Blender's data and core's: no operators, no panels, no user interface."""
