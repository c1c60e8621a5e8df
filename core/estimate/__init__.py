"""Posture estimation from observations and prior: the whole-clip estimate, the filter, single frames."""
