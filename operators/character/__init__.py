"""Step 8, the character: the motion given to any other armature."""

PROPERTIES = ("map_properties", "properties")
MODULES = (
    "add_character",
    "add_rigify_human",
    "remove_character",
    "make_override",
    "recognize_character",
    "pick_bone",
    "chain_bones",
    "mirror_roles",
    "save_map",
    "load_map",
    "retarget",
    "show_result",
    "remove_result",
    "mark_result_asset",
    "panel",
)
