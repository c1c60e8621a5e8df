"""Recognition of a character's bones: names as tokens, topology and geometry, weighed together."""
