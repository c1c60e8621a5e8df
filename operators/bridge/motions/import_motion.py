"""Import an animated armature from a file: its Action on whole frames, its rate, and a person's size."""

from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import bpy
import numpy as np
from bpy.types import Action, Object, Scene
from mathutils import Matrix

from ....core.body import rotations
from ....core.errors import InputError
from ....core.files.fields import listed
from ....core.files.paths import real_path
from ....core.numerics.vectors import unit
from ....core.progress import run
from ....core.retarget.maps.map_registry import ChosenMap
from ....core.retarget.mended_armature import ArmaturePoints
from ....core.retarget.solve.rest_body import RestBody
from ....core.take.conversion_settings import CharacterFile
from ....core.take.named_points import chosen_subject
from ....core.take.point_files import FASTEST, SLOWEST, read_bvh
from ....core.take.reference import ARMATURE_ENDINGS, ReferenceMotion
from ..actions import assign_action, curves_of, existing_channelbag
from ..blend_files import own_scene, showing_scene
from ..character.held_controls import BONE_PATH
from ..character.import_character import ImportedCharacter, import_character
from ..character.read_character import read_character
from ..keys import mark_generated
from .read_poses import action_frames, animated_action, motion_map, read_poses

UNITS = (1.0, 0.01, 0.1, 0.001, 0.0254, 0.3048, 100.0)
"""Meters that a file's unit may have: m, cm, dm, mm, inches, feet; and characters in hundreds of meters."""
Curves = Mapping[tuple[str, int], bpy.types.FCurve]
SHORTEST_LEG_M, LONGEST_LEG_M = 0.35, 1.5  # of a child and of a giant


def import_motion(
    file: CharacterFile, scene: Scene, maps: Sequence[Path] = (), action_name: str | None = None
) -> tuple[ImportedCharacter, ChosenMap]:
    """Import an animated armature into a scene, which gets the motion's rate, and recognize its bones.

    A BVH's object is one of its ROOTs; `action_name` is one of several Actions. The motion's keys count as
    Keymark's own: those that a person sets later are known. It is scaled to a person's size. InputError where
    Blender cannot read it, or it has no armature of a person, no Action, or no usable rate.
    """
    suffix = file.path.suffix.lower()
    if suffix not in ARMATURE_ENDINGS:
        raise InputError(
            f"{file.path}: is no motion of an armature; it must end in {listed(ARMATURE_ENDINGS)}"
        )
    text: str | None = None
    notes: tuple[str, ...] = ()
    if suffix == ".bvh":
        text, notes = read_bvh(file.path, file.object)
        file = CharacterFile(file.path)  # its one armature
    elif suffix.startswith(".usd") and not bpy.app.build_options.usd:
        raise InputError(f"{file.path}: this Blender is built without USD; export the motion as BVH or FBX")
    before = {one.session_uid for one in bpy.data.actions}
    imported = import_character(file, scene, animated=True, text=text)
    armature = imported.armature
    added = [one for one in bpy.data.actions if one.session_uid not in before]
    action, which = _action(file.path, armature, added, action_name)
    notes = (*notes, *which)
    if suffix.startswith(".usd"):
        _set_rate(scene, _usd_rate(file.path))
    elif suffix == ".blend":
        _set_rate(scene, _blend_rate(file.path))
    _set_to_keys(scene, armature, action, file.path)
    try:
        chosen = motion_map(armature, maps)
        body = RestBody.of(read_character(armature), chosen.character_map)
    except InputError as error:
        raise InputError(f"{file.path}: {error}") from error
    up = unit(np.array(armature.matrix_world, dtype=np.float64)[:3, :3] @ body.stance.T @ [0.0, 0.0, 1.0])
    if suffix == ".bvh" and up[2] < np.cos(np.radians(45.0)):  # which tells not whether Y is up, or as here Z
        upright = rotations.smallest(up, np.array([0.0, 0.0, 1.0]))
        armature.matrix_world = Matrix(upright).to_4x4() @ armature.matrix_world
        bpy.context.view_layer.update()
    leg_m = body.leg_m
    meters = min(UNITS, key=lambda meters: abs(np.log(leg_m * meters / 0.85)))
    if not SHORTEST_LEG_M <= leg_m <= LONGEST_LEG_M and meters != 1.0:
        if not SHORTEST_LEG_M <= leg_m * meters <= LONGEST_LEG_M:
            raise InputError(
                f"{file.path}: its legs are {leg_m:.3g} m long, which are no person's in any unit"
            )
        armature.scale = np.array(armature.scale) * meters
        armature.location = np.array(armature.location) * meters
        scene.view_layers[0].update()
    bag = existing_channelbag(action, armature)
    if bag is not None:
        mark_generated(bag)
    return replace(imported, notes=(*notes, *imported.notes)), chosen


def load_motion(
    file: CharacterFile, scene: Scene, maps: Sequence[Path] = (), action_name: str | None = None
) -> tuple[Object, tuple[str, ...]]:
    """Bring an armature into a scene, from whose first frame on it moves as long as in the file; notes."""
    before = {block.as_pointer() for block in bpy.data.user_map()}
    meanwhile = bpy.data.scenes.new("Motion")
    try:
        imported, _ = import_motion(file, meanwhile, maps, action_name)
        armature = imported.armature
        action = armature.animation_data.action
        factor = scene.render.fps / scene.render.fps_base
        factor /= meanwhile.render.fps / meanwhile.render.fps_base
        _retime(curves_of(action, armature), meanwhile.frame_start, factor, scene.frame_start)
        for collection in list(meanwhile.collection.children):
            scene.collection.children.link(collection)
    except BaseException:
        bpy.data.scenes.remove(meanwhile)
        made = [block for block in bpy.data.user_map() if block.as_pointer() not in before]
        bpy.data.batch_remove(made)
        raise
    bpy.data.scenes.remove(meanwhile)
    return armature, imported.notes


def armature_reference(path: Path, subject: str | None, maps: Sequence[Path] = ()) -> ReferenceMotion:
    """The joints of a file's animated armature as a reference motion, by `import_motion`; the scene stays."""
    with own_scene("Motion") as scene, showing_scene(scene):
        imported, chosen = import_motion(CharacterFile(path, subject), scene, maps)
        armature = imported.armature
        points = ArmaturePoints.of(RestBody.of(read_character(armature), chosen.character_map))
        action = animated_action(armature)
        poses, _ = run(read_poses(armature, action, action_frames(armature, action), points.bones))
        rate = scene.render.fps / scene.render.fps_base
        return ReferenceMotion(points.of_poses(poses), rate, str(path), imported.notes)


def _retime(curves: Curves, first: float, factor: float, start: float) -> None:
    """Let keys begin at `start` instead of `first`, and follow at `factor` times their distance."""
    for curve in curves.values():
        for key in curve.keyframe_points:
            for handle in (key.co, key.handle_left, key.handle_right):
                handle[0] = start + (handle[0] - first) * factor
        curve.update()


def _action(
    path: Path, armature: Object, added: Sequence[Action], wanted: str | None
) -> tuple[Action, tuple[str, ...]]:
    """Assign the wanted Action, else its own, its first strip's or the file's first; mute strips; notes."""
    data = armature.animation_data_create()
    strips = (strip.action for track in data.nla_tracks for strip in track.strips)
    moving = [one for one in added if _moves(one, armature)]
    actions = [one for one in dict.fromkeys([data.action, *strips, *moving]) if one is not None]
    if not actions:
        raise InputError(f"{path}: its armature '{armature.name}' has no Action, so it has no motion")
    names = [_own_name(one, added) for one in actions]
    # An FBX's take is the middle of the name that the importer gives: ARMATURE|TAKE|LAYER.
    wanted = next((name for name in names if wanted in name.split("|")[1:2]), wanted)
    index, notes = chosen_subject(path, names, [1.0] * len(names), wanted, "Action")
    for track in data.nla_tracks:
        track.mute = True
    if data.action != actions[index]:
        assign_action(armature, actions[index])
    return actions[index], notes


def _moves(action: Action, armature: Object) -> bool:
    curves = [path for path, _ in curves_of(action, armature)]
    found = [match for match in map(BONE_PATH.match, curves) if match]
    bones = armature.pose.bones
    return any(bpy.utils.unescape_identifier(match[1]) in bones for match in found)


def _own_name(action: Action, added: Sequence[Action]) -> str:
    """An Action's name in its file, without the number that it got where the name was taken."""
    stem, _, number = action.name.rpartition(".")
    taken = any(one.name == stem and one not in added for one in bpy.data.actions)
    return str(stem if number.isdigit() and taken else action.name)


def _usd_rate(path: Path) -> float:
    """The rate of a USD's time codes; Blender's importer leaves the scene's as it is."""
    with suppress(ImportError, AttributeError, RuntimeError):
        bpy.utils.expose_bundled_modules()
        from pxr import Usd

        return float(Usd.Stage.Open(str(path)).GetTimeCodesPerSecond())
    return 24.0  # USD's own default


def _blend_rate(path: Path) -> float:
    with bpy.data.libraries.load(str(real_path(path)), link=True) as (inside, wanted):
        wanted.scenes = list(inside.scenes)[:1]
    rates = [scene.render.fps / scene.render.fps_base for scene in wanted.scenes if scene is not None]
    for scene in wanted.scenes:
        if scene is not None:
            bpy.data.libraries.remove(scene.library)
    return rates[0] if rates else 24.0


def _set_rate(scene: Scene, rate: float) -> None:
    scene.render.fps = max(1, round(rate))
    scene.render.fps_base = scene.render.fps / rate


def _set_to_keys(scene: Scene, armature: Object, action: Action, path: Path) -> None:
    """Give the scene the rate of an Action's keys and its range; keys between frames come to lie on them."""
    curves = curves_of(action, armature)
    moving = [curve for curve in curves.values() if len(curve.keyframe_points) > 1]
    if not moving:
        raise InputError(f"{path}: Action '{action.name}' has no keys over two frames, so it has no motion")
    densest = max(moving, key=lambda curve: len(curve.keyframe_points))
    times = np.empty(2 * len(densest.keyframe_points), np.float32)
    densest.keyframe_points.foreach_get("co", times)
    times = times[::2]
    step = float(np.median(np.diff(times)))
    rate = scene.render.fps / scene.render.fps_base
    between = not np.allclose(times, np.round(times), atol=1e-2)
    if between and step > 0.0:  # the file has a rate of its own, and Blender put its seconds into frames
        if not SLOWEST <= rate / step <= FASTEST:
            raise InputError(
                f"{path}: its keys follow at {rate / step:.4g} a second; {SLOWEST:g} to {FASTEST:g} are valid"
            )
        _retime(curves, float(times[0]), 1.0 / step, 1.0)
        rate /= step
    # A step of 0.033333 s means 30 frames a second.
    _set_rate(scene, float(round(rate)) if abs(rate - round(rate)) < 5e-4 * rate else rate)
    scene.frame_start, scene.frame_end = (round(value) for value in action.frame_range)
    scene.frame_set(scene.frame_start)
