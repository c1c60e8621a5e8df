"""Step 4, the keyframes: frames proposed for posing, and posing the actor in them and correcting it."""

MODULES = (
    "propose_keyframes",
    "jump_to_proposal",
    "fit_pose",
    "show_offered",
    "store_keyframe",
    "flip_depth",
    "turn_performer",
    "copy_neighbor",
    "move_joint",
    "drag_joints",
    "panel",
    "correct_panel",
)
