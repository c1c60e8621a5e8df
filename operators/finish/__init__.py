"""Step 7, the finish: the final Action, as an asset and as a file for other programs."""

PROPERTIES = ("properties",)
MODULES = ("bake_motion", "panel")
