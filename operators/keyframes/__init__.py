"""Step 4, the keyframes: frames proposed for posing, and posing the actor in them."""

MODULES = ("propose_keyframes", "jump_to_proposal", "fit_pose", "store_keyframe", "panel")
