"""Step 5, the reconstruction: from keyframes and footage to the motion."""

MODULES = ("reconstruct", "panel")
