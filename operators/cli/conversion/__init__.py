"""One take in, one complete folder of results out: what is made of it, kept of it, and said of it."""
