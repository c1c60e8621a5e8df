"""Keyframe libraries of keyframes, of pose assets, and learned from a motion."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import bpy
import numpy as np

from ....core.arrays import Array
from ....core.body.actor import Actor
from ....core.body.body_volume import lower_sole_m
from ....core.body.human import HUMAN
from ....core.body.kinematics import Body
from ....core.body.posture import Posture, headings_rad, turned_and_shifted
from ....core.errors import InputError
from ....core.prior.learning import LibraryMetadata, learn_library, numbered_names
from ....core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from ....core.prior.texts import identifier_from, unique_name
from ....core.prior.transfer import transferred
from ..actor_lengths import read_body
from ..keyframes import keyed_frames, read_keyframes
from ..posture_curves import read_posture_curves
from ..rig import shown_motion
from .pose_assets import is_posture, library_from_assets


def library_of_keyframes(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    about: LibraryMetadata,
) -> Library:
    """The keyframes of an Action, a posture each, and a motion through them at their times.

    Raises:
        InputError: There are fewer than two keyframes, the armature is not an actor's, or title, author or
            license is invalid.
    """
    body = read_body(armature_object, HUMAN)
    frames = np.array(keyed_frames(armature_object, action, HUMAN))
    if len(frames) < 2:
        raise InputError(f"the take has {len(frames)} keyframes; a library needs two or more")
    posed = read_keyframes(scene, armature_object, action, body, frames).keyframes
    postures = _leveled(body, Posture.stack([keyframe.posture for keyframe in posed]))
    names = numbered_names(about.title, len(posed))
    time_s: Array = (frames - frames[0]) * scene.render.fps_base / scene.render.fps
    steps = tuple(MotionStep(name, round(float(at), 4)) for name, at in zip(names, time_s, strict=True))
    entries = tuple(LibraryPosture(name, postures[row]) for row, name in enumerate(names))
    motion = LibraryMotion(about.title, steps, steps[-1].time_s)
    return _checked(replace(_empty(body, about), postures=entries, motions=(motion,)))


def library_of_assets(
    actions: Iterable[bpy.types.Action],
    armature_object: bpy.types.Object | None,
    about: LibraryMetadata,
    identifier: str,
) -> Library:
    """The library that pose assets belong to, with an actor's pose assets that belong to none, if given.

    Linked Actions are ignored. Of several libraries that with the identifier is taken; a new one has the
    details `about`.

    Raises:
        InputError: There are no pose assets, or those of several other libraries, or one is unusable.
    """
    local = [action for action in actions if action.library is None]
    found = {library.identifier: library for library in library_from_assets(local)}
    if len(found) > 1 and identifier not in found:
        raise InputError(
            f"this file has the pose assets of {', '.join(found)}; choose one of these in the list"
        )
    library = found.get(identifier) or next(iter(found.values()), None)
    body = None if armature_object is None else read_body(armature_object, HUMAN)
    loose = [] if body is None else list(_loose(local, body))
    if library is None:
        if body is None or not loose:
            raise InputError("this file has no pose assets of a library, and none of the take's actor")
        library = _empty(body, about)
    entries = list(library.postures)
    for name, actor, posture in loose:
        fitted = transferred(posture, actor, Body(library.actor))
        entries.append(LibraryPosture(unique_name(name, [entry.name for entry in entries]), fitted))
    return _checked(replace(library, postures=tuple(entries)))


def _loose(actions: Iterable[bpy.types.Action], body: Body) -> Iterator[tuple[str, Actor, Posture]]:
    """Names, proportions and leveled postures of pose assets of a body that belong to no library."""
    for action in actions:
        first, last = action.curve_frame_range
        if action.asset_data is not None and not is_posture(action) and first == last:
            posture = read_posture_curves(action, body)
            if posture is not None:
                yield action.name, body.actor, _leveled(body, Posture.stack([posture]))[0]


def _leveled(body: Body, postures: Posture) -> Posture:
    """Postures (F,) of one performance, the first above the origin facing -Y, the lowest sole at z = 0."""
    turned = turned_and_shifted(postures, -headings_rad(postures[:1])[0], np.zeros(3))
    offset = turned.translation[0] * [-1.0, -1.0, 0.0]
    offset[2] = -lower_sole_m(body, turned).min()
    return turned_and_shifted(turned, np.zeros(1), offset)


def _empty(body: Body, about: LibraryMetadata) -> Library:
    identifier = about.identifier or identifier_from(about.title)
    return Library(identifier, about.title, 1, about.author, about.license, body.actor, ())


def _checked(library: Library) -> Library:
    """The library, which is what a file may hold: names are typed by people."""
    Library.from_json(library.to_json(), f"library '{library.title}'")
    return library


def library_from_action(
    scene: bpy.types.Scene,
    armature_object: bpy.types.Object,
    action: bpy.types.Action,
    about: LibraryMetadata,
    count: int | None,
) -> Library:
    """Learn a library from the motion that an Action holds for an actor.

    It has `count` postures; by default 10 to 40, as many as differ.
    """
    motion = shown_motion(scene, armature_object, action)
    return _checked(learn_library(motion.body, motion.posture, motion.time_s, about, count))
