"""Step 2, the performer: the performer's armature, built from a height or measured in the footage."""

PROPERTIES = ("properties",)
MODULES = ("build_actor", "panel")
