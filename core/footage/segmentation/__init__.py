"""From pixels to regions: where in an image a colour is, and the moments of it."""
