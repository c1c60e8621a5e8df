"""What follows from observations and prior: the filter, the whole-clip estimate, their consistency."""
