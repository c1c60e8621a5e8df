"""Step 6, export: the final Action, as an asset and as a file for other programs."""

PROPERTIES = ("properties",)
MODULES = ("bake_motion", "panel")
