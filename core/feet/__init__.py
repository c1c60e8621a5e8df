"""Feet of any rig: where they rest, the ground under them, what plants them, how hands and feet hang."""
