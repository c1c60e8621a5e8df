"""Reading and writing files that can be trusted: strict JSON, checked fields, folders that appear whole."""
