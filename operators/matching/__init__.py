"""Finding keyframes in the footage: choosing among candidates."""

PROPERTIES = ("properties",)
MODULES = (
    "pose_all",
    "jump_to_match",
    "replace_match",
    "accept_match",
    "remove_match",
    "remove_found",
    "panel",
)
