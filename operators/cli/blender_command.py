"""The command `blender --command keymark ...`."""

from typing import Any

import bpy

_registered: list[Any] = []
"""Blender's handle of the command, which it wants back to take the command away."""


def run_command(arguments: list[str]) -> int:
    """Run the command line with what follows the command's name; returns the exit status."""
    from .main import main

    return main(arguments)


def register() -> None:
    """Add the command."""
    _registered.append(bpy.utils.register_cli_command("keymark", run_command))


def unregister() -> None:
    """Take the command away."""
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
