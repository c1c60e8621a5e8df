"""What Keymark draws over Blender's editors, from what is in memory: a draw function reads no file."""
