"""Keyframe libraries in Blender: pose assets, files, transfer to an actor, learning from an Action."""
