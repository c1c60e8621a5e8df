"""Words that stand for several libraries where one is named; apart, for the command line's help is quick."""

EVERY_LIBRARY = "auto"
"""Stands for all libraries where one is named; hence no valid identifier."""
COMPOSED = "composed"
"""Stands for the library of a posture put together from parts of several; hence no valid identifier."""
