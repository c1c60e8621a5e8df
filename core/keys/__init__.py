"""Few keys: curves through them, the rig they move, and the reduction that keeps it within tolerances."""
