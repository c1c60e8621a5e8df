"""The kinds of files that a motion can be exported to, and whether this Blender can write them."""

from dataclasses import dataclass

import bpy


@dataclass(frozen=True)
class Format:
    """A kind of file."""

    name: str
    suffix: str
    words: str
    """What it is for."""
    operator: str
    """Type of the operator that an add-on gives Blender for it; empty where Blender has it built in."""
    addon: str
    """Name of the add-on."""

    def missing(self) -> str:
        """Why this Blender cannot write it; empty where it can."""
        if self.operator:
            there = hasattr(bpy.types, self.operator)
            return "" if there else f"Enable the add-on {self.addon} in the Preferences"
        return "" if bpy.app.build_options.usd else f"This Blender is built without {self.name}"


FORMATS = {
    "BVH": Format(
        "BVH",
        ".bvh",
        "Write skeleton and motion as text, which most animation programs read",
        "EXPORT_ANIM_OT_bvh",
        "BioVision Motion Capture (BVH)",
    ),
    "FBX": Format(
        "FBX", ".fbx", "Write for game engines and other animation programs", "EXPORT_SCENE_OT_fbx", "FBX"
    ),
    "GLTF": Format(
        "glTF", ".glb", "Write one binary file for engines and the web", "EXPORT_SCENE_OT_gltf", "glTF 2.0"
    ),
    "USD": Format("USD", ".usdc", "Write for film pipelines: a skeleton with its animation", "", ""),
}
"""By identifier."""
