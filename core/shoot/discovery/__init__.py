"""The takes of a shoot, found below a folder or read from a list, and what they may be called."""
