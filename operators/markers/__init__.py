"""Step 2, the markers: garments in strong colors, picked from the footage and checked in it."""

PROPERTIES = ("properties",)
MODULES = (
    "add_marker",
    "add_usual_markers",
    "remove_marker",
    "check_markers",
    "pick_marker_color",
    "show_masks",
    "panel",
)
