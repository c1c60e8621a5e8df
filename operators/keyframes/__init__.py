"""Step 4, the keyframes: proposed frames, and posing the actor there."""

MODULES = ("propose_keyframes", "jump_to_proposal", "fit_pose", "store_keyframe", "panel")
