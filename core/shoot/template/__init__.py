"""A new description of a shoot, from what its clips tell."""
