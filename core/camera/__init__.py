"""The camera: lens, place, and how it moves."""
