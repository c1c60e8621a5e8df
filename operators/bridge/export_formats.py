"""Registry of export formats: names, suffix, the exporter Blender needs, and the writer of each.

A new format is one entry of `FORMATS`, with its writer beside it: the export panel, the operator's menu, its
tooltip and the filter of its file browser are made from these.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import bpy

from ...core.errors import ConversionError

BVH_ORDER = "ZXY"
"""One order of rotation channels for all joints: some readers take the first joint's for all."""


@dataclass(frozen=True)
class ExportFormat:
    """A file format that a motion can be exported to."""

    name: str
    suffix: str
    description: str
    """Tooltip: what the format is for."""
    write: Callable[[bpy.types.Object, Path], None]
    """Write the motion of an armature over its scene's frames, with the other selected objects."""
    operator_type: str = ""
    """Class name of the exporter that an add-on registers; empty where Blender has it built in."""
    addon: str = ""
    """Name of the add-on, as in the Preferences."""

    def missing(self) -> str | None:
        """Why this Blender cannot write the format; None where it can."""
        if self.operator_type:
            if hasattr(bpy.types, self.operator_type):
                return None
            return f"Enable the add-on {self.addon} in the Preferences"
        if bpy.app.build_options.usd:
            return None
        return f"This Blender is built without {self.name}"


def write_bvh(armature_object: bpy.types.Object, path: Path) -> None:
    """Export an armature's motion over its scene's frames with Blender's own BVH exporter.

    Raises:
        ConversionError: The exporter failed.
    """
    scene = armature_object.users_scene[0]
    layer = scene.view_layers[0]
    layer.objects.active = armature_object
    with bpy.context.temp_override(
        scene=scene, view_layer=layer, object=armature_object, active_object=armature_object
    ):
        try:
            bpy.ops.export_anim.bvh(
                filepath=str(path),
                frame_start=scene.frame_start,
                frame_end=scene.frame_end,
                rotate_mode=BVH_ORDER,
                root_transform_only=True,
            )
        except (RuntimeError, AttributeError) as error:
            raise ConversionError(f"{path}: Blender's BVH exporter failed ({str(error).strip()})") from error


def _write_fbx(_: bpy.types.Object, path: Path) -> None:
    bpy.ops.export_scene.fbx(
        filepath=str(path),
        use_selection=True,
        object_types={"ARMATURE", "MESH", "EMPTY"},
        add_leaf_bones=False,
        bake_anim=True,
        bake_anim_use_nla_strips=False,
        bake_anim_use_all_actions=False,
        bake_anim_simplify_factor=0.0,
        check_existing=False,
    )


def _write_gltf(_: bpy.types.Object, path: Path) -> None:
    bpy.ops.export_scene.gltf(
        filepath=str(path),
        export_format="GLB",
        use_selection=True,
        export_animations=True,
        export_animation_mode="ACTIVE_ACTIONS",
        export_frame_range=True,
        export_force_sampling=True,
        export_anim_slide_to_zero=True,
        export_def_bones=False,
        check_existing=False,
    )


def _write_usd(_: bpy.types.Object, path: Path) -> None:
    bpy.ops.wm.usd_export(
        filepath=str(path),
        selected_objects_only=True,
        export_animation=True,
        export_armatures=True,
        only_deform_bones=False,
        export_materials=False,
        check_existing=False,
    )


FORMATS = {
    "BVH": ExportFormat(
        "BVH",
        ".bvh",
        "Write skeleton and motion as text, which most animation programs read",
        write_bvh,
        "EXPORT_ANIM_OT_bvh",
        "BioVision Motion Capture (BVH)",
    ),
    "FBX": ExportFormat(
        "FBX",
        ".fbx",
        "Write for game engines and other animation programs",
        _write_fbx,
        "EXPORT_SCENE_OT_fbx",
        "FBX",
    ),
    "GLTF": ExportFormat(
        "glTF",
        ".glb",
        "Write one binary file for engines and the web",
        _write_gltf,
        "EXPORT_SCENE_OT_gltf",
        "glTF 2.0",
    ),
    "USD": ExportFormat(
        "USD", ".usdc", "Write for film pipelines: a skeleton with its animation", _write_usd
    ),
}
"""By identifier, in the order in which the export panel shows them."""
