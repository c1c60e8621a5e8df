"""Step 2, the markers: what the performer wears, its colors, and how well it is found."""

PROPERTIES = ("properties",)
MODULES = ("add_marker", "remove_marker", "check_markers", "pick_marker_color", "show_masks", "panel")
