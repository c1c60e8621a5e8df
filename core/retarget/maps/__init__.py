"""Character maps: what they hold, their files, where they are found, and the presets of conventions."""
