"""The one button: from a clip and the performer's height to a motion, and onto a character."""

MODULES = ("animate",)
