"""Discovery of a shoot's takes, below a folder or in a list, and the rules for their names."""
