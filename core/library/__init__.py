"""Keyframe libraries: named postures with their order and timing, kept as files and shared."""
