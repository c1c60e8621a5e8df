"""Names of the ways to a motion, for whoever asks: also for `--help`, which waits for nothing else."""

METHODS = ("map", "ekf", "interpolation")
"""The whole clip at once, which is the default; the filter of the paper; the keyframes alone."""
