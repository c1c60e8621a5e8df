"""Keyframe libraries: named postures with their order and timing, as files to share."""
