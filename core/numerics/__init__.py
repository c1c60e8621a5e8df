"""Numerical methods that know nothing of bodies or footage."""
