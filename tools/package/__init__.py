"""The extension's zips: for which Blenders, with which wheels, of which files."""
