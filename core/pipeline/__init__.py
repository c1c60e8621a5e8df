"""The way from a take to a motion: its keyframes read or found, reconstruction, and the record of the result."""
