"""Finding keyframes in the footage: all at once, or with one library; choosing among candidates."""

PROPERTIES = ("properties",)
MODULES = (
    "pose_all",
    "match_library",
    "jump_to_match",
    "replace_match",
    "accept_match",
    "remove_match",
    "remove_found",
    "panel",
)
