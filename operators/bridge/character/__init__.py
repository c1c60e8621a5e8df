"""Characters in Blender: armatures read as arrays, their controls probed, retargeted motions written."""
