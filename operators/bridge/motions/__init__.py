"""Motions of any armature: read from its Action or from a file, mended, and written back."""
