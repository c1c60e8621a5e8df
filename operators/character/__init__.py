"""Step 5, the character: the motion given to any other armature."""

PROPERTIES = ("map_properties", "properties")
MODULES = ("add_character", "recognition", "pick_bone", "retarget", "mend_motion", "panel")
