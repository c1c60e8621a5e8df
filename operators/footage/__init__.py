"""Step 1, the footage: the clip, the camera it was filmed with, and how a viewport shows it."""

PROPERTIES = ("properties",)
MODULES = (
    "load_footage",
    "use_clip",
    "relocate_clip",
    "confirm_lens",
    "confirm_camera",
    "panel",
)
