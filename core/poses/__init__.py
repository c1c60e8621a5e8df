"""Poses that nobody posed: candidates of a frame, the likeliest sequence of them, and what contradicts."""
