"""What the commands on libraries, characters and detectors do: `detect` for `commands/detect.py`, and so on."""
