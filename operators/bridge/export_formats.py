"""Export of a motion by Blender's own exporters: names, suffix, add-on and writer of each format.

A new format is one entry of `FORMATS`, with its writer beside it: the export panel, the operator's menu, its
tooltip and the filter of its file browser are made from these.
"""

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, Object, Scene

from ...core.errors import ConversionError, InputError
from ...core.files.json_file import write_atomically
from ...core.take.motion import write_motion
from .rig import present_frames, shown_motion
from .scene_frames import showing_action


@dataclass(frozen=True)
class ExportFormat:
    """A file format that a motion can be exported to."""

    name: str
    suffix: str
    description: str  # tooltip: what the format is for
    write: Callable[[Object, Path], None]  # of an armature over its scene's frames, with what is selected
    operator_type: str = ""  # class name of the exporter that an add-on registers; else empty
    addon: str = ""  # name of the add-on, as in the Preferences
    built_in: bool = False  # whether Keymark writes it itself
    of_actor: bool = False  # whether it holds the performer's own motion alone

    def missing(self) -> str | None:
        """Why this Blender cannot write the format; None where it can."""
        if self.operator_type and not hasattr(bpy.types, self.operator_type):
            return f"Enable the add-on {self.addon} in the Preferences"
        there = self.operator_type or self.built_in or bpy.app.build_options.usd
        return None if there else f"This Blender is built without {self.name}"


def write_bvh(armature_object: Object, path: Path) -> None:
    """Export a motion over its scene's frames with Blender's BVH exporter; ConversionError if that fails."""
    scene = armature_object.users_scene[0]
    layer = scene.view_layers[0]
    layer.objects.active = armature_object
    shown = {"object": armature_object, "active_object": armature_object}
    with bpy.context.temp_override(scene=scene, view_layer=layer, **shown):
        try:
            bpy.ops.export_anim.bvh(
                filepath=str(path),
                frame_start=scene.frame_start,
                frame_end=scene.frame_end,
                rotate_mode="ZXY",  # one order for all joints: some readers take the first one's for all
                root_transform_only=True,
            )
        except (RuntimeError, AttributeError) as error:
            raise ConversionError(f"{path}: Blender's BVH exporter failed ({str(error).strip()})") from error


def _written_by(exporter: str, **options: object) -> Callable[[Object, Path], None]:
    group, name = exporter.split(".")

    def write(_: Object, path: Path) -> None:
        operator = getattr(getattr(bpy.ops, group), name)
        operator(filepath=str(path), check_existing=False, **options)

    return write


def _write_points(armature_object: Object, path: Path) -> None:
    from ...core.take import point_files
    from .motions.read_poses import joint_paths

    write = point_files.write_trc if path.suffix.lower() == ".trc" else point_files.write_c3d
    write(path, *joint_paths(armature_object))


def _write_keymark(armature_object: Object, path: Path) -> None:
    """Write an actor's motion as `motion.json`, which the command line retargets and learns from."""
    action = armature_object.animation_data.action
    motion = shown_motion(armature_object.users_scene[0], armature_object, action)
    present = present_frames(armature_object, action, motion.fps)
    write_motion(motion.emptied(np.isin(np.round(motion.scene_frames), present)), path)


FORMATS = {
    "KEYMARK": ExportFormat(
        "Keymark Motion",
        ".json",
        "Write the performer's motion.json, as Keymark keeps it, for its command line and your programs",
        _write_keymark,
        built_in=True,
        of_actor=True,
    ),
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
        _written_by(
            "export_scene.fbx",
            use_selection=True,
            object_types={"ARMATURE", "MESH", "EMPTY"},
            add_leaf_bones=False,
            bake_anim=True,
            bake_anim_use_nla_strips=False,
            bake_anim_use_all_actions=False,
            bake_anim_simplify_factor=0.0,
        ),
        "EXPORT_SCENE_OT_fbx",
        "FBX",
    ),
    "GLTF": ExportFormat(
        "glTF",
        ".glb",
        "Write one binary file for engines and the web",
        _written_by(
            "export_scene.gltf",
            export_format="GLB",
            use_selection=True,
            export_animations=True,
            export_animation_mode="ACTIVE_ACTIONS",
            export_frame_range=True,
            export_force_sampling=True,
            export_anim_slide_to_zero=True,
            export_def_bones=False,
        ),
        "EXPORT_SCENE_OT_gltf",
        "glTF 2.0",
    ),
    "USD": ExportFormat(
        "USD",
        ".usdc",
        "Write for film pipelines: a skeleton with its animation",
        _written_by(
            "wm.usd_export",
            selected_objects_only=True,
            export_animation=True,
            export_armatures=True,
            only_deform_bones=False,
            export_materials=False,
        ),
    ),
    "TRC": ExportFormat(
        "TRC",
        ".trc",
        "Write the places of the joints for biomechanics: OpenSim, Pose2Sim and others",
        _write_points,
        built_in=True,
    ),
    "C3D": ExportFormat(
        "C3D",
        ".c3d",
        "Write the places of the joints as motion capture's own format has them",
        _write_points,
        built_in=True,
    ),
}
"""By identifier, in the order in which the export panel shows them."""


def export_motion(
    scene: Scene,
    armature_object: Object,
    action: Action,
    frames: tuple[int, int],
    export_format: ExportFormat,
    path: Path,
    along: Sequence[Object] = (),
) -> None:
    """Write a motion over `frames`, with objects `along` and nothing else, into a whole file, or raise."""

    def write(beside: Path) -> None:
        try:
            export_format.write(armature_object, beside)
        except RuntimeError as error:
            raise ConversionError(f"{path}: the exporter failed ({str(error).strip()})") from error
        if not beside.exists():
            raise ConversionError(f"{path}: the exporter wrote nothing")

    before = scene.frame_start, scene.frame_end, scene.use_preview_range
    at, subframe = scene.frame_current, scene.frame_subframe
    with _only(scene, armature_object, along), showing_action(armature_object, action):
        scene.frame_start, scene.frame_end, scene.use_preview_range = *frames, False
        try:
            write_atomically(path, write)
        finally:
            scene.frame_start, scene.frame_end, scene.use_preview_range = before
            scene.frame_set(at, subframe=subframe)


@contextmanager
def _only(scene: Scene, chosen: Object, along: Sequence[Object]) -> Iterator[None]:
    """Select some objects only and make one active, in object mode; then restore selection and mode."""

    def set_mode(mode: str, now: str) -> None:
        if mode != now and bpy.ops.object.mode_set.poll():
            bpy.ops.object.mode_set(mode=mode)

    layer = bpy.context.view_layer if bpy.context.scene == scene else scene.view_layers[0]
    active, hidden = layer.objects.active, chosen.hide_get(view_layer=layer)
    mode = active.mode if active is not None else "OBJECT"
    selected = [one for one in layer.objects if one.select_get(view_layer=layer)]
    try:
        set_mode("OBJECT", mode)
        chosen.hide_set(False, view_layer=layer)
        if not chosen.visible_get(view_layer=layer):
            raise InputError(f"'{chosen.name}' is hidden with its collection; show it to export its motion")
        for one in selected:
            one.select_set(False, view_layer=layer)
        for one in (*along, chosen):
            if one.name in layer.objects:
                one.select_set(True, view_layer=layer)
        layer.objects.active = chosen
        yield
    finally:
        for one in layer.objects:
            one.select_set(one in selected, view_layer=layer)
        chosen.hide_set(hidden, view_layer=layer)
        layer.objects.active = active
        set_mode(mode, "OBJECT")
