"""A network of somebody's own that looks beside Keymark's; the add-on's preferences remember its file."""

from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.types import AddonPreferences, Context, UILayout

from ..shell.fields import Text
from ..shell.results import EXTENSION

if TYPE_CHECKING:
    from ...core.detect.families.network import Network


class KEYMARK_AP_preferences(bpy.types.AddonPreferences):
    """What holds for every file."""

    bl_idname = EXTENSION

    network: Text(
        "Network",
        "A network's file (.onnx) that looks for points of the body beside Keymark's own, as InstantHMR's "
        "or RTMPose's; empty for Keymark's own alone",
        subtype="FILE_PATH",
    )

    def draw(self, context: Context) -> None:
        self.layout.use_property_split = True
        draw_network(self.layout)


def _preferences() -> AddonPreferences | None:
    """Keymark's; None where it is not installed as an add-on."""
    addon = bpy.context.preferences.addons.get(EXTENSION)
    return None if addon is None else addon.preferences


def draw_network(layout: UILayout) -> None:
    """Draw whose network looks, where that can be remembered."""
    preferences = _preferences()
    if preferences is not None:
        layout.prop(preferences, "network", placeholder="Keymark's Own")


def chosen_network() -> "Network | None":
    """The network that is chosen in the preferences; None for Keymark's own alone."""
    from ...core.detect.families.table import open_network

    preferences = _preferences()
    if preferences is None or not preferences.network:
        return None
    return open_network(Path(bpy.path.abspath(preferences.network)))
