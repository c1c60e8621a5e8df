"""What the commands on libraries, characters and detectors do: `detect` for `commands/detect`, and so on."""
