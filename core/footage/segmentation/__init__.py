"""Segmentation: the regions of the markers' colors in an image, and their moments."""
