"""Converting every take of a shoot, several at a time."""
