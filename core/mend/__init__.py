"""A motion from elsewhere mended without footage."""
