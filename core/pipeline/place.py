"""A take of which only the clip and the performer's height are known: seen by the pose network, then placed.

Somebody of known height who stands or walks upright on the floor measures the room (`standing_moments`,
`camera_fit`). The world's origin is where the performer is in the middle of these moments, and the floor is
z = 0.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ..camera.camera import EYE_HEIGHT_M, Camera, default_camera_pose, guess_lens, lens_of_equivalent
from ..camera.camera_evidence import CameraEvidence, Uprights
from ..camera.camera_fields import MATRICES
from ..camera.camera_fit import LENS, PARAMETERS, CameraFit, fit_camera
from ..detect.keypoints import People
from ..detect.pose_network import PoseNetwork
from ..detect.pose_tracking import find_people, refuse_picture
from ..detect.standing_moments import standing_keypoints
from ..errors import pluralize
from ..files.fields import PLACED, Fields, InheritedFields, listed
from ..progress import Job, Progress, stretch
from ..take.clip_check import open_footage
from ..take.conversion_settings import ConversionSettings
from ..take.description import ASSUMED, Description, keypoint_files
from ..take.evidence import KEYPOINTS
from ..take.performer_keypoints import performer_keypoints
from ..take.take import Take, with_evidence
from ..take.take_file import read_described
from ..video.stated_lens import stated_lens_mm

FEWEST_MOMENTS = 2
"""Upright moments that tell a camera; one is the same from a camera high above and from a low one."""
SEEN = 0.98  # share of the job at which the keypoints are found


@dataclass(frozen=True, eq=False)
class PlacedTake:
    """A take whose camera was found."""

    take: Take
    floor_m: float | None
    """Height of the floor [m]; None where it could not be told."""
    findings: tuple[str, ...]
    """What was assumed and found, and how sure it is: a line for each stage."""


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


def place_take(description: Description, settings: ConversionSettings) -> Job[PlacedTake]:
    """See the performer in the clip, and find the camera by them.

    Raises:
        InputError: The clip or the performer's size is missing or unusable, or nobody is seen.
    """
    take, lens = take_to_place(description, settings)
    files = keypoint_files(description, settings)
    seen = f"read from {listed(file.name for file in files)}"
    if not files:
        job = find_people(open_footage(description.clip, take.fps), PoseNetwork())
        people = yield from stretch(job, 0.0, SEEN)
        take, seen = replace(take, keypoints=(people,)), seen_in_words(people)
    yield Progress("Placing the camera", SEEN)
    uprights = standing_keypoints(performer_keypoints(take, None), take.body, take.fps)
    camera, fit = camera_by_performer(take.camera, lens.is_known, uprights)
    is_assumed = description.fields.source_of("actor") == ASSUMED
    findings = (
        f"Keypoints: {seen}",
        f"Camera: {camera_in_words(fit, lens, len(uprights))}",
        f"Actor: {actor_in_words(take.body.actor.stature_m, is_assumed)}",
    )
    take = replace(take, camera=camera)
    if settings.evidence is not None:
        take = with_evidence(take, settings.evidence)
    return PlacedTake(take, None if fit is None else 0.0, findings)


def take_to_place(description: Description, settings: ConversionSettings) -> tuple[Take, "Lens"]:
    """A take before its camera is found, which is put where cameras usually stand.

    Raises:
        InputError: The clip or the performer's size is missing or unusable.
    """
    fields, clip = description.fields, open_footage(description.clip, None)
    refuse_picture(clip)
    lens = lens_of(clip.path, clip.size, fields.values.get("camera"), fields.source_of("camera"))
    described = _with_camera(description, lens.put(clip.size))
    whole = replace(settings, keypoints=keypoint_files(description, settings), evidence=None)
    take = read_described(described, fewest_keyframes=0, keyframes_required=False, settings=whole)
    return take, lens


@dataclass(frozen=True)
class Lens:
    """A lens before anything is found."""

    lens_mm: float
    sensor_width_mm: float
    source: str
    """Who says so, in brackets after its number."""
    is_known: bool

    def put(self, size: tuple[int, int]) -> Camera:
        """A camera with this lens where cameras usually stand, for a picture of this size [px]."""
        pose = default_camera_pose(self.lens_mm, self.sensor_width_mm, size)
        return Camera(self.lens_mm, self.sensor_width_mm, size, pose)


def lens_of(path: Path, size: tuple[int, int], said: object = None, where: str = "") -> Lens:
    """The lens that a description says, else the one that the clip states, else a guess by its size [px]."""
    if isinstance(said, Mapping) and said.get("lens_mm") is not None:
        pose = np.eye(4).tolist()
        given = Camera.from_dict({**said, "resolution": list(size), "matrix_world": pose}, f"{where}: camera")
        return Lens(given.lens_mm, given.sensor_width_mm, "as described", True)
    stated_mm = stated_lens_mm(path)
    if stated_mm is not None:
        return Lens(*lens_of_equivalent(stated_mm, size), f"the clip states {stated_mm:g} mm", True)
    guess = guess_lens(size)
    return Lens(guess.lens_mm, guess.sensor_width_mm, f"a guess, as of {guess.reason}", False)


def camera_by_performer(
    put: Camera, lens_is_known: bool, uprights: Uprights
) -> tuple[Camera, CameraFit | None]:
    """The camera that upright moments show, with the performer about the world's origin.

    Where there are too few of them, it is the camera as it was put, and there is no fit.
    """
    if len(uprights) < FEWEST_MOMENTS:
        return put, None
    fit = fit_camera(put, CameraEvidence(uprights=uprights), lens_is_known)
    location, sight = fit.camera.rays(uprights.lower_px)
    falls = sight[:, 2] < 0.0
    if not falls.any():
        return fit.camera, fit
    far = (location[2] - uprights.lower_m) / np.where(falls, -sight[:, 2], np.inf)
    ground = location[:2] + far[:, None] * sight[:, :2]
    pose = fit.camera.matrix_world.copy()
    pose[:2, 3] -= np.median(ground[falls], axis=0)
    return replace(fit.camera, matrix_world=pose), fit


def seen_in_words(people: People) -> str:
    """In how many frames somebody is seen."""
    who = "somebody" if people.most_people == 1 else f"up to {people.most_people} people"
    return f"{who} in {people.seen_frames} of {pluralize(len(people.frames), 'frame')}, by {people.source}"


def camera_in_words(fit: CameraFit | None, lens: Lens, moments: int) -> str:
    """What was found of a camera, and what was assumed."""
    if fit is None:
        return (
            f"assumed to be level at {EYE_HEIGHT_M:g} m, lens {lens.lens_mm:.1f} mm ({lens.source}); the "
            "performer stands upright at no two moments, by which it would be found"
        )
    found = [fit.said(name) for name in PARAMETERS if name not in fit.kept]
    kept = [fit.said(name) for name in PARAMETERS if name in fit.kept and name != LENS]
    kept += [f"{fit.said(LENS)} ({lens.source})"] if LENS in fit.kept else []
    parts = [", ".join(found) or "nothing found"] + ([f"assumed: {', '.join(kept)}"] if kept else [])
    return f"{'; '.join(parts)}; by {moments} moments in which the performer is upright"


def actor_in_words(stature_m: float, is_assumed: bool) -> str:
    """How tall the performer is, and whether anybody said so."""
    sure = "assumed, so that all distances may be a tenth off" if is_assumed else "of average proportions"
    return f"{stature_m:.2f} m tall, {sure}"


def _with_camera(description: Description, camera: Camera) -> Description:
    """The description with a camera."""
    fields = description.fields
    values = fields.values if isinstance(fields.values, InheritedFields) else InheritedFields()
    found = values.overridden_by({"camera": None}, "").overridden_by({"camera": camera.to_dict()}, "(found)")
    return replace(description, fields=Fields(found, fields.where))
