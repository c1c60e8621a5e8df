"""Keymark: animation of any character from one video of a performer and a few keyframes.

The repository root is the Blender extension. Nothing of Blender is imported here before `register()`,
so that the same tree serves as the ordinary Python package `keymark`.
"""


def register() -> None:
    """Add Keymark's operators, panels and command to the running Blender."""
    from . import operators

    operators.register()


def unregister() -> None:
    """Take them away again, in the reverse order."""
    from . import operators

    operators.unregister()
