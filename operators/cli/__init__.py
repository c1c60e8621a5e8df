"""The command line: `keymark ...`, `python -m keymark ...` and `blender --command keymark ...`."""

MODULES = ("blender_command",)
