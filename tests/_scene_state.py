"""What scenes and result folders hold, as plain values that are the same in every run."""

import hashlib
import json
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

import bpy
import numpy as np
from _faults import tree
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.files.digest import content_digest
from keymark.core.files.paths import real_path
from keymark.core.poses.candidates import Candidate, MatchedFrame
from keymark.core.prior.library import Library, LibraryPosture
from keymark.core.session.result import AS_MADE
from keymark.core.take.conversion_record import read_record
from keymark.core.take.motion import Motion
from keymark.operators.bridge.actions import curve_digest
from keymark.operators.bridge.actor_lengths import read_body
from keymark.operators.bridge.pose import read_posture
from keymark.operators.shell.takes import active_take

State = dict[str, Any]
DIGITS = 4


def scene_state() -> State:
    """Everything that Keymark may change, of every scene, object, Action and clip."""
    state: State = {}
    for scene in bpy.data.scenes:
        name = f"scene {scene.name}"
        state[f"{name} range"] = (scene.frame_start, scene.frame_end, scene.frame_current)
        state[f"{name} rate"] = round(scene.render.fps / scene.render.fps_base, DIGITS)
        state[f"{name} size"] = (scene.render.resolution_x, scene.render.resolution_y)
        state[f"{name} shows"] = (_name(scene.camera), _name(scene.active_clip))
        _add_group(state, f"{name} keymark", scene.keymark)
    for blender_object in bpy.data.objects:
        _add_object(state, blender_object)
    for action in bpy.data.actions:
        _add_action(state, action)
    for clip in bpy.data.movieclips:
        lens = clip.tracking.camera
        state[f"clip {clip.name}"] = (clip.filepath, clip.frame_start, clip.frame_offset)
        state[f"clip {clip.name} lens"] = _rounded((lens.focal_length, lens.sensor_width, lens.k1, lens.k2))
    for collection in bpy.data.collections:
        state[f"collection {collection.name}"] = sorted(item.name for item in collection.all_objects)
    return state


def differences(before: State, after: State) -> str:
    """The differences between two states, one clause each; empty if there are none."""
    names = sorted(before.keys() | after.keys())
    differing = [name for name in names if before.get(name) != after.get(name)]
    return "; ".join(f"{name}: {before.get(name)} became {after.get(name)}" for name in differing)[:1000]


def assert_undoable(steps: Iterable[tuple[str, Callable[[], object]]]) -> None:
    """Hold that every step, by its name, changes something, is undone by one undo and redone by one redo."""
    bpy.ops.ed.undo_push(message="Begin")
    for name, do in steps:
        before = scene_state()
        do()
        bpy.context.view_layer.update()
        bpy.ops.ed.undo_push(message=name)
        after = scene_state()
        assert after != before, f"{name} changed nothing"
        bpy.ops.ed.undo()
        assert not differences(before, scene_state()), f"undoing {name}"
        bpy.ops.ed.redo()
        assert not differences(after, scene_state()), f"redoing {name}"


def _add_group(state: State, name: str, group: bpy.types.bpy_struct) -> None:
    """Every property of a group of properties, the groups in it included."""
    for definition in group.bl_rna.properties:
        key = definition.identifier
        if key == "rna_type":
            continue
        value = getattr(group, key)
        if definition.type == "COLLECTION":
            state[f"{name}.{key}"] = len(value)
            for number, item in enumerate(value):
                _add_group(state, f"{name}.{key}[{number}]", item)
        elif definition.type == "POINTER" and isinstance(value, bpy.types.PropertyGroup):
            _add_group(state, f"{name}.{key}", value)
        elif definition.type == "POINTER":
            state[f"{name}.{key}"] = _name(value)
        else:
            state[f"{name}.{key}"] = _rounded(value)


def _add_object(state: State, blender_object: bpy.types.Object) -> None:
    name = f"object {blender_object.name}"
    data = blender_object.animation_data
    state[name] = (blender_object.type, _name(blender_object.data), _name(blender_object.parent))
    state[f"{name} matrix"] = _rounded(np.array(blender_object.matrix_world).ravel())
    state[f"{name} action"] = _name(data.action) if data else None
    if blender_object.type == "CAMERA":
        lens = blender_object.data
        state[f"{name} lens"] = _rounded((lens.lens, lens.sensor_width, lens.shift_x, lens.shift_y))
    if blender_object.type == "ARMATURE":
        for bone in blender_object.data.bones:
            state[f"{name} bone {bone.name}"] = _rounded((*bone.head_local, *bone.tail_local))
        if data is None or data.action is None:  # else Blender's own undo gives what the Action says
            for bone in blender_object.pose.bones:
                state[f"{name} pose {bone.name}"] = _rounded(np.array(bone.matrix_basis).ravel())


def _add_action(state: State, action: bpy.types.Action) -> None:
    name = f"action {action.name}"
    tags = sorted(tag.name for tag in action.asset_data.tags) if action.asset_data else None
    state[name] = (action.use_fake_user, [slot.identifier for slot in action.slots], tags)
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    state[f"{name} {curve.data_path}[{curve.array_index}]"] = _curve(curve)


def _curve(curve: bpy.types.FCurve) -> tuple[int, str]:
    """Number of keys, and a digest of their positions and types."""
    keys = np.empty(2 * len(curve.keyframe_points), dtype=np.float32)
    kinds = np.empty(len(curve.keyframe_points), dtype=np.int32)
    curve.keyframe_points.foreach_get("co", keys)
    curve.keyframe_points.foreach_get("type", kinds)
    said = np.round(keys, DIGITS).tobytes() + kinds.tobytes()
    return len(curve.keyframe_points), hashlib.sha256(said).hexdigest()[:12]


def _name(item: Any) -> str | None:
    return None if item is None else str(item.name)


def _rounded(value: Any) -> Any:
    if isinstance(value, float):
        return round(value, DIGITS) + 0.0
    if isinstance(value, str | int | bool | set | frozenset) or value is None:
        return value
    return tuple(_rounded(part if isinstance(part, int | str) else float(part)) for part in value)


# --- Found keyframes made up from a motion, as finding gives them


def wave_library(motion: Motion, identifier: str = "waves") -> Library:
    """A library of three postures of a motion."""
    postures = tuple(LibraryPosture(f"Wave {i}", motion.posture[i]) for i in (0, 6, 12))
    return Library(identifier, identifier.title(), 1, "Somebody", "CC0-1.0", motion.body.actor, postures)


def made_up_frames(motion: Motion, confidences: Mapping[int, float]) -> tuple[MatchedFrame, ...]:
    """Frames with the motion's postures, of a confidence each, and another posture that each may show."""
    return tuple(
        MatchedFrame(
            index,
            (
                Candidate(motion.posture[index], f"Wave {index}", False, confidence),
                Candidate(motion.posture[12 - index], "Back", True, 0.25),
            ),
        )
        for index, confidence in confidences.items()
    )


def shown(take: bpy.types.PropertyGroup, frame: int) -> Posture:
    """The posture that the actor shows at a frame."""
    bpy.context.scene.frame_set(frame)
    return read_posture(take.armature, read_body(take.armature, HUMAN)).posture


# --- The posture that the actor of a scene's active take shows


def posture_of(scene: bpy.types.Scene) -> Posture:
    """The actor's posture."""
    armature_object = active_take(scene).armature
    return read_posture(armature_object, read_body(armature_object, HUMAN)).posture


# --- The content of result folders that is the same in every run


VARYING = ("motion.blend", "character.blend", AS_MADE)
"""Blender writes memory addresses into its files; the record has the digest of their curves."""


def same_in_every_run(folder: Path) -> dict[str, bytes | None]:
    """All files below a folder but .blend files and their digests."""
    return {name: content for name, content in tree(folder).items() if not name.endswith(VARYING)}


def is_whole(folder: Path) -> bool:
    """Whether a folder counts as finished; then every file must match its record."""
    if not (folder / "conversion.json").exists():
        return False
    record = read_record(folder)
    for name, digest in record.files.items():
        if name not in VARYING:
            assert content_digest(folder / name) == digest, f"{name} is not the one of its record"
    as_made = json.loads((folder / AS_MADE).read_text(encoding="utf-8"))
    for name, digest in as_made.items():
        assert content_digest(folder / name) == digest
    assert "motion.blend" in as_made
    return True


def blend_is_of(folder: Path) -> bool:
    """Whether the curves in motion.blend are those of the record."""
    before = set(bpy.data.user_map())
    with bpy.data.libraries.load(str(real_path(folder / "motion.blend"))) as (found, wanted):
        wanted.objects = found.objects
    digests = {curve_digest(thing) for thing in wanted.objects if thing.type == "ARMATURE"}
    bpy.data.batch_remove(set(bpy.data.user_map()) - before)
    return digests == {read_record(folder).files["motion.blend"]}


def finished_folders(folder: Path) -> list[Path]:
    """Folders of results below a folder; what stands in hidden ones is not finished."""
    records = (record.relative_to(folder) for record in folder.rglob("conversion.json"))
    return [
        folder / record.parent
        for record in records
        if not any(part.startswith(".keymark") for part in record.parts)
    ]


def hidden_files(folder: Path) -> list[str]:
    """The hidden files that killed processes have left."""
    return [name for name in tree(folder) if Path(name).name.startswith(".keymark-")]
