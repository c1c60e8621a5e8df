"""The command `blender --command keymark ...`."""

from typing import Any

import bpy

_registered: list[Any] = []
"""The handle by which Blender unregisters the command."""


def run_command(arguments: list[str]) -> int:
    """Run the command line with the arguments after the command's name; returns the exit status."""
    from .main import main

    return main(arguments)


def register() -> None:
    """Register the command."""
    _registered.append(bpy.utils.register_cli_command("keymark", run_command))


def unregister() -> None:
    """Unregister the command."""
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
