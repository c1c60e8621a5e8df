"""The keyframe library that is made in this file: pose assets for its postures, properties for the rest."""
