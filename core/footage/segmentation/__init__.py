"""From pixels to regions: where in an image a color is, and the moments of it."""
