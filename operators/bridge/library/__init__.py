"""Keyframe libraries in Blender: as pose assets and files, on an actor, and learned from an Action."""
