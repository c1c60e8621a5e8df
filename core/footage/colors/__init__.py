"""Colors: spaces, distributions and models, learned from a clip."""
