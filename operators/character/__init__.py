"""Step 8, the character: the motion given to any other armature."""

PROPERTIES = ()
MODULES = ()
