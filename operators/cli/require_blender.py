"""A check for Blender before the work begins, shared by the commands that write or read a .blend."""

import importlib.util

from ...core.errors import ConversionError


def require_blender(needing: str) -> None:
    """Refuse work that needs Blender where there is none, at once rather than after minutes.

    Args:
        needing: What the sentence begins with, as in `writing motion.blend needs`.

    Raises:
        ConversionError: The Python module `bpy` is missing.
    """
    if importlib.util.find_spec("bpy") is None:
        raise ConversionError(
            f"{needing} Blender: install its Python module (pip install 'keymark[blender]') "
            "or run blender --command keymark in a Blender that has Keymark"
        )
