"""What the commands on libraries, characters and detectors do: `use_cases/detect.py` for `commands/detect.py`, and so on."""
