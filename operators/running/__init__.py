"""How operators run: as jobs with progress, with what they need, saying what went wrong."""
