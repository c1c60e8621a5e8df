"""Trustworthy reading and writing of files: strict JSON, checked fields, folders committed as a whole."""
