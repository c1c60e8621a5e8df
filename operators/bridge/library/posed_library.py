"""Keyframe libraries of keyframes, of pose assets, and learned from a motion."""

from collections.abc import Iterable
from dataclasses import replace

import numpy as np
from bpy.types import Action, Object, Scene

from ....core.arrays import Array
from ....core.body.body_volume import lower_sole_m
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
    scene: Scene, armature_object: Object, action: Action, about: LibraryMetadata
) -> Library:
    """The keyframes of an Action, of which there must be two, as postures and a motion through them."""
    body = read_body(armature_object)
    frames = np.array(keyed_frames(armature_object, action))
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
    actions: Iterable[Action], armature_object: Object | None, about: LibraryMetadata, identifier: str
) -> Library:
    """The library that pose assets belong to, with an actor's pose assets of one frame that belong to none.

    Linked Actions are ignored. Of several libraries that with the identifier is taken; a new one has the
    details `about`. InputError where there are no pose assets, or of several other libraries.
    """
    local = [action for action in actions if action.library is None]
    found = {library.identifier: library for library in library_from_assets(local)}
    if len(found) > 1 and identifier not in found:
        there = ", ".join(found)
        raise InputError(f"this file has the pose assets of {there}; choose one of these in the list")
    library = found.get(identifier) or next(iter(found.values()), None)
    loose: list[tuple[str, Body, Posture]] = []
    if armature_object is not None:
        body = read_body(armature_object)
        for action in local:
            first, last = action.curve_frame_range
            if action.asset_data is not None and not is_posture(action) and first == last:
                posture = read_posture_curves(action, body)
                if posture is not None:
                    loose.append((action.name, body, _leveled(body, Posture.stack([posture]))[0]))
    if library is None:
        if not loose:
            raise InputError("this file has no pose assets of a library, and none of the take's actor")
        library = _empty(loose[0][1], about)
    entries = list(library.postures)
    for name, body, posture in loose:
        fitted = transferred(posture, body.actor, Body(library.actor))
        entries.append(LibraryPosture(unique_name(name, [entry.name for entry in entries]), fitted))
    return _checked(replace(library, postures=tuple(entries)))


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
    scene: Scene, armature_object: Object, action: Action, about: LibraryMetadata, count: int | None
) -> Library:
    """Learn a library of `count` postures, or as many as differ, from the motion that an Action holds."""
    motion = shown_motion(scene, armature_object, action)
    return _checked(learn_library(motion.body, motion.posture, motion.time_s, about, count))
