"""A character's controls: in which space each acts, its channels, and few keys on FK and IK together."""
