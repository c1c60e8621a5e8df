"""Step 1, the clip, the camera it was filmed with, and how a viewport shows it."""

PROPERTIES = ("properties",)
MODULES = ("load_footage", "panel")
