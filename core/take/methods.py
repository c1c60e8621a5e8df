"""Method names; imports nothing, so that `--help` stays fast."""

METHODS = ("map", "ekf", "interpolation")
"""The estimate over the whole clip, the default; the paper's Kalman filter; interpolated keyframes alone."""
