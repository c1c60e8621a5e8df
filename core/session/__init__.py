"""The way of a take from its clip to a character, as one list of stages, and the files of its result."""
