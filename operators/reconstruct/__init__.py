"""Step 4, the motion: from keyframes and footage to the motion."""

MODULES = ("reconstruct", "panel")
