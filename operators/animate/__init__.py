"""The one button: from a clip and the performer's height to a motion, and onto a character."""

MODULES = ("animate",)

NOTHING, RIGIFY, FILE = "NONE", "RIGIFY", "FILE"
"""Characters beside those that stand in the scene, which are called by their names."""
