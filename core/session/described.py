"""What a session starts from as files describe it: a take, or a clip and the performer's height."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..camera.camera import Camera, Lens, guess_lens, lens_of_equivalent
from ..camera.camera_fields import MATRICES
from ..detect.families.table import open_network
from ..detect.pose_tracking import refuse_picture
from ..errors import pluralize
from ..files.fields import PLACED, Fields, InheritedFields, listed
from ..prior.library import Library
from ..take.conversion_settings import METHODS, ConversionSettings
from ..take.description import ASSUMED, Description, keypoint_files
from ..take.evidence import KEYPOINTS
from ..take.keyframe_file import FEWEST_KEYFRAMES
from ..take.read_footage import open_footage
from ..take.reference import ReadArmature
from ..take.take import with_evidence
from ..take.take_file import read_described
from ..video.header import stated_lens_mm
from .place import camera_in_words
from .see import people_in_words
from .session import Inputs, Placed, Posed, Session, Sight


def is_unplaced(description: Description, settings: ConversionSettings) -> bool:
    """Whether a take's camera is to be found: nothing says where it stood, and nobody has posed anything."""
    camera = description.fields.values.get("camera")
    placed = isinstance(camera, Mapping) and any(name in camera for name in (*MATRICES, *PLACED))
    searched = settings.library is not None and settings.keyframes is None
    followed = settings.evidence is None or KEYPOINTS in settings.evidence
    return searched and followed and not placed and (camera is None or isinstance(camera, Mapping))


def is_detected(description: Description, settings: ConversionSettings) -> bool:
    """Whether a take's conversion detects the performer's keypoints."""
    return is_unplaced(description, settings) and not keypoint_files(description, settings)


def described(
    description: Description,
    settings: ConversionSettings,
    libraries: Sequence[Library] = (),
    read_armature: ReadArmature | None = None,
) -> Inputs:
    """Read what a session starts from; `read_armature` reads a reference motion that only Blender can.

    A camera that nobody has placed is put where cameras usually stand. Where keyframes are found, those that
    an earlier run has found are left out.

    Raises:
        InputError: The take cannot be used, or its clip or the performer's size is missing.
    """
    searched = None if settings.library is None else libraries
    if is_unplaced(description, settings):
        inputs = _unplaced(description, settings)
    else:
        fewest = FEWEST_KEYFRAMES if searched is None else 0 if settings.keyframes is None else 1
        take = read_described(
            description,
            settings.keyframes,
            keyframes_required=searched is None,
            fewest_keyframes=fewest,
            settings=settings,
            read_armature=read_armature,
        )
        if searched is not None:
            take = replace(take, keyframes=tuple(key for key in take.keyframes if key.matched is None))
        inputs = Inputs(take)
    method = settings.method or METHODS[0]
    return replace(
        inputs,
        hands=settings.hands is not False,
        method=method,
        libraries=searched,
        floor_m=settings.floor_m,
        shot=settings.shot,
        performer=settings.performer,
    )


def _unplaced(description: Description, settings: ConversionSettings) -> Inputs:
    fields, clip = description.fields, open_footage(description.clip, None)
    refuse_picture(clip)
    lens = lens_of(clip.path, clip.size, fields.values.get("camera"), fields.source_of("camera"))
    files = keypoint_files(description, settings)
    whole = replace(settings, keypoints=files, evidence=None)
    values = fields.values if isinstance(fields.values, InheritedFields) else InheritedFields()
    camera = lens.put(clip.size).to_dict()
    values = values.overridden_by({"camera": None}, "").overridden_by({"camera": camera}, "(found)")
    with_lens = replace(description, fields=Fields(values, fields.where))
    take = read_described(with_lens, fewest_keyframes=0, keyframes_required=False, settings=whole)
    if settings.evidence is not None:
        take = with_evidence(take, settings.evidence)
    detects, evidence = not files, settings.evidence
    network = open_network(settings.network) if detects and settings.network is not None else None
    return Inputs(take, evidence=evidence, detects=detects, network=network, open_lens=lens, floor_open=True)


def lens_of(path: Path, size: tuple[int, int], said: object = None, where: str = "") -> Lens:
    """The lens that a description says, else the one that the clip states, else a guess by its size [px]."""
    if isinstance(said, Mapping) and said.get("lens_mm") is not None:
        pose = np.eye(4).tolist()
        given = Camera.from_dict({**said, "resolution": list(size), "matrix_world": pose}, f"{where}: camera")
        return Lens(given.lens_mm, given.sensor_width_mm, "as described", True)
    stated_mm = stated_lens_mm(path)
    if stated_mm is not None:
        return Lens(*lens_of_equivalent(stated_mm, size), f"the clip states {stated_mm:g} mm", True)
    return guess_lens(size)


def findings(session: Session, description: Description) -> tuple[str, ...]:
    """What was assumed and found of a take whose camera nobody has placed, a line for each stage."""
    camera, keyframes, take = session[Placed].camera, session[Posed].seen.take.keyframes, session.inputs.take
    if camera is None:
        return ()
    if session.inputs.detects:
        shown = session[Placed].seen
        people = session[Sight].people if shown.reading.shot is None else shown.take.keypoints
        seen = people_in_words(people[0])
    else:
        seen = f"read from {listed(Path(people.file).name for people in take.keypoints)}"
    is_assumed = description.fields.source_of("actor") == ASSUMED
    sure = "assumed, so that all distances may be a tenth off" if is_assumed else "of average proportions"
    doubtful = sum(key.matched is not None and key.matched.is_doubtful for key in keyframes)
    return (
        f"Keypoints: {seen}",
        f"Camera: {camera_in_words(camera)}",
        f"Actor: {take.body.actor.stature_m:.2f} m tall, {sure}",
        f"Poses: {pluralize(len(keyframes), 'keyframe')} found, {doubtful} of them doubtful",
    )
