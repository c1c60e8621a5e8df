"""Colors: color space, the markers' color model and how it is learned from a clip."""
