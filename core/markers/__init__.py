"""Colored markers: their colors, their regions in the picture, and their tracks through a clip."""
