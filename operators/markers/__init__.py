"""Step 2, what to follow, and the markers: garments in strong colors, picked from the footage and checked."""

PROPERTIES = ("properties",)
MODULES = (
    "add_marker",
    "add_usual_markers",
    "remove_marker",
    "check_markers",
    "pick_marker_color",
    "show_masks",
    "follow_panel",
    "panel",
)
