"""The keyframe library that is made in this file: its postures are pose assets, the rest properties."""
