"""Finding a library's postures in footage."""
