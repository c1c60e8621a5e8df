"""Step 2, what to follow, and the markers: garments in strong colors, picked from the footage and checked."""

PROPERTIES = ("ignored_properties", "properties")
MODULES = (
    "add_marker",
    "add_usual_markers",
    "remove_marker",
    "check_markers",
    "pick_marker_color",
    "pick_markers",
    "ignore_region",
    "ignore_still_areas",
    "remove_ignored_region",
    "show_masks",
    "follow_panel",
    "panel",
)
