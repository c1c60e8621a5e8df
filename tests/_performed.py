"""A performance of a library's motion by somebody else, filmed: what matching is tested with."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from _libraries import sample_motion
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture, yawed_at
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import People, SeenPeople, mirrored_point
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import MarkerStyle, RegionTracks
from keymark.core.poses.found_poses import FoundPoses
from keymark.core.prior.library import Library
from keymark.core.take.take import Take
from keymark.core.terms.keypoints import KeypointModel
from keymark.core.terms.region_model import MarkerPlacement, RegionModel

SEGMENTS = ("trunk", "forearm.L", "forearm.R", "shin.L", "shin.R")
BODY = Body(Actor.from_stature(1.62))
FRAMES, FPS = 50, 25.0
VIEW = np.array([[1.0, 0.0, 0.0], [0.0, 0.2, -0.98], [0.0, 0.98, 0.2]])


def camera(frames: int = 0) -> Camera:
    """A camera four meters before the performer, a little above; one that drifts where frames are given."""
    rotation, _ = np.linalg.qr(VIEW)
    rotation *= np.sign(np.diag(rotation.T @ VIEW))
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = rotation, (0.0, -4.5, 1.7)
    if frames:
        matrix = np.repeat(matrix[None], frames, axis=0)
        matrix[:, 0, 3] = np.linspace(-0.3, 0.3, frames)
    return Camera(40.0, 36.0, (640, 480), matrix)


def performed(library: Library, heading_rad: float, style_rad: float = 0.08, floor_m: float = 0.0) -> Posture:
    """The library's first motion as this performer does it: a little faster, every joint turned a little."""
    rng = np.random.default_rng(3)
    time = 0.2 + 1.1 * np.arange(FRAMES) / FPS
    led = sample_motion(library, library.motions[0], BODY, time)
    style = rng.normal(0.0, style_rad, led.skeleton.dof_count)
    style[:6] = 0.0
    led = led.plus(style)
    turn = np.array([[np.cos(heading_rad), -np.sin(heading_rad)], [np.sin(heading_rad), np.cos(heading_rad)]])
    middle = led.translation[:, :2].mean(axis=0)
    hips = np.column_stack([(led.translation[:, :2] - middle) @ turn.T, led.translation[:, 2] + floor_m])
    return yawed_at(led, np.full(FRAMES, heading_rad), hips)


def filmed(posture: Posture, seen_by: Camera, hidden: float = 0.0) -> tuple[Take, Reading]:
    """A take and the tracks that the performance leaves in its picture, with noise of half a pixel."""
    rng = np.random.default_rng(5)
    frames = len(posture.translation)
    model = RegionModel(BODY, seen_by, tuple(MarkerPlacement(segment) for segment in SEGMENTS))
    shown = model.evaluate(BODY.pose(posture), np.arange(frames))
    lost = (shown.visible < 0.1) | (rng.random(shown.visible.shape) < hidden)
    centroid = np.where(lost[..., None], np.nan, shown.centroid + rng.normal(0.0, 0.5, shown.centroid.shape))
    tracks = RegionTracks(
        SEGMENTS,
        centroid,
        np.where(lost[..., None, None], np.nan, shown.second_moment),
        np.where(lost, np.nan, shown.area),
        np.where(lost, 0.0, np.clip(shown.visible, 0.0, 1.0)),
        np.zeros_like(lost),
        np.arange(frames) / FPS,
        seen_by.resolution,
    )
    styles = tuple(MarkerStyle(name, name, (40 * i, 20, 200 - 30 * i)) for i, name in enumerate(SEGMENTS))
    take = Take(Path("take"), Path("clip.mp4"), FPS, 1, frames, seen_by, BODY, styles, ())
    return take, Reading(tracks)


def errors_m(found: FoundPoses, truth: Posture) -> tuple[float, float]:
    """Mean distance of the points from the truth, with the hips aligned and absolutely."""
    points, true = (BODY.points(BODY.pose(posture)) for posture in (found.postures, truth))
    off = points - true
    hips = (found.postures.translation - truth.translation)[:, None]
    return (float(np.linalg.norm(off - hips, axis=-1).mean()), float(np.linalg.norm(off, axis=-1).mean()))


NAMES = (
    "nose", "ear.L", "ear.R",
    *(f"{joint}.{side}" for joint in ("shoulder", "elbow", "wrist", "hip", "knee", "ankle") for side in "LR"),
)  # fmt: skip
MIRRORED = [NAMES.index(mirrored_point(name)) for name in NAMES]


def detected(posture: Posture, seen_by: Camera, wrong: float = 0.0) -> People:
    """What a detector finds: jitter, some points anywhere, and nobody in every ninth frame."""
    rng = np.random.default_rng(8)
    frames = np.arange(len(posture.translation))
    pose = BODY.pose(posture)
    model = KeypointModel.usual(BODY, seen_by, NAMES)
    pixel = model.pixels(pose, frames) + rng.normal(0.0, 2.0, (len(frames), len(NAMES), 2))
    far = rng.random(pixel.shape[:2]) < wrong
    pixel[far] = rng.uniform(0.0, 480.0, (far.sum(), 2))
    depth = model.camera.depth(model.world(pose), frames[:, None])
    depth = depth - depth[:, [NAMES.index("hip.L"), NAMES.index("hip.R")]].mean(axis=1, keepdims=True)
    middle = model.world(pose)[:, [NAMES.index("hip.L"), NAMES.index("hip.R")]].mean(axis=1, keepdims=True)
    hint = (model.world(pose) - middle) @ (seen_by.pose(0)[0] * [1.0, -1.0, -1.0])
    hint[..., 2] = depth + rng.normal(0.0, 0.08, len(NAMES))  # alike in all frames
    seen = [
        SeenPeople(pixel[[i]][: 0 if i % 9 == 8 else 1], np.full((1, len(NAMES)), 0.9), hint[[i]])
        for i in frames
    ]
    seen = [
        replace(one, score=one.score[: len(one.pixel)], hint_m=one.hint_m[: len(one.pixel)]) for one in seen
    ]
    return People(NAMES, "test", seen_by.resolution, tuple(seen))


def exchanged(people: People, frames: range) -> People:
    changed = tuple(
        SeenPeople(seen.pixel[:, MIRRORED], seen.score[:, MIRRORED], seen.hint_m[:, MIRRORED])
        if index in frames
        else seen
        for index, seen in enumerate(people.frames)
    )
    return replace(people, frames=changed)


def unmarked(posture: Posture, seen_by: Camera, people: People) -> tuple[Take, Reading]:
    """The take of a performer who wears anything, with keypoints."""
    take, reading = filmed(posture, seen_by)
    tracks = RegionTracks.unmarked(reading.tracks.time_s, reading.tracks.size)
    return replace(take, markers=(), keypoints=(people,)), Reading(tracks)
