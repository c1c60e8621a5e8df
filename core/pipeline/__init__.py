"""The way from a take to a motion: keyframes read or found, reconstruction, and the record of the result."""
