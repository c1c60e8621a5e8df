"""What each command does: `use_cases/convert.py` is run by `commands/convert.py`, and so on."""
