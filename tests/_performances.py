"""Motions for tests: what a performer does, networks' motions, corrected postures and reviews of numbers."""

import csv
import json
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
from _characters import plain_character, plain_map
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body, SegmentMotion, segment_motion
from keymark.core.body.posture import Posture, turned_and_shifted
from keymark.core.body.posture_fit import fit_posture
from keymark.core.camera.camera import Camera
from keymark.core.feet.natural_extremities import natural_extremities
from keymark.core.progress import run
from keymark.core.retarget.character import Character, Similarity
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.maps.character_map import CharacterMap
from keymark.core.retarget.quality import Quality, measured
from keymark.core.retarget.solve.solve_motion import solve_motion
from keymark.core.review.compared_keypoints import ComparedKeypoints
from keymark.core.review.review import Reason, Review, WeakFrame
from keymark.core.take.conversion_settings import RetargetOptions

DEMO = Path(__file__).resolve().parents[1] / "presets" / "demo" / "aerobic"
FPS = 30.0


@cache
def stepping() -> tuple[Body, Posture]:
    """The demonstration's steps to the side and jumping jacks, by its true points."""
    take = json.loads((DEMO / "take.json").read_text(encoding="utf-8"))
    points = json.loads((DEMO / "truth.json").read_text(encoding="utf-8"))["points"]
    body = Body(Actor(take["actor"]["segments_m"]))
    rows = np.stack([np.array(points[name]) for name in body.skeleton.point_names], axis=1)
    return body, fit_posture(body, rows).posture


def performance(body: Body, posture: Posture) -> SegmentMotion:
    """The segments of a motion of 30 frames a second, with natural hands and feet."""
    time_s = np.arange(posture.batch[0]) / FPS
    return segment_motion(body, posture, time_s, natural_extremities(body, posture, time_s))


@cache
def steps() -> SegmentMotion:
    """The performance of `stepping`."""
    return performance(*stepping())


@cache
def steps_elsewhere() -> SegmentMotion:
    """The same, turned by 70 degrees and done elsewhere."""
    body, posture = stepping()
    return performance(body, turned_and_shifted(posture, np.radians(70.0), np.array([2.0, -1.0, 0.0])))


def with_hands(left: Array, right: Array, frames: int = 60) -> SegmentMotion:
    """A performer of 1.75 m who stands, hips at 0.93 m, and brings the wrists to two places [m]."""
    body = Body(Actor.from_stature(1.75))
    skeleton = body.skeleton
    vector = np.zeros((frames, skeleton.dof_count))
    vector[:, 2] = 0.93
    points = body.points(body.pose(Posture.from_vector(skeleton, vector)))
    share = np.clip(np.linspace(-0.3, 1.6, frames), 0.0, 1.0)[:, None]
    share = share * share * (3.0 - 2.0 * share)
    for side, out, place in (("L", 1.0, left), ("R", -1.0, right)):
        shoulder = points[0, skeleton.point_names.index(f"shoulder.{side}")]
        hanging = shoulder + [0.05 * out, -0.05, -0.5]
        points[:, skeleton.point_names.index(f"wrist.{side}")] = (1.0 - share) * hanging + share * place
        points[:, skeleton.point_names.index(f"elbow.{side}")] = np.nan
        vector[:, skeleton.dof_names.index(f"elbow.{side}.flexion")] = 0.8
        vector[:, skeleton.dof_names.index(f"shoulder.{side}.rotation_y")] = 1.1 * out
    return performance(body, fit_posture(body, points, Posture.from_vector(skeleton, vector)).posture)


def shaped(change: Callable[[str, Array], Array], **shape: float) -> tuple[Character, CharacterMap]:
    """A plain character whose joints are moved: `change` takes a bone's name and a place (3,) of it."""
    character = plain_character(**shape)  # type: ignore[arg-type]
    bones = []
    for bone in character.bones:
        rest = bone.rest.copy()
        rest[:3, 3] = change(bone.name, bone.head)
        bones.append(replace(bone, rest=rest, tail=change(bone.name, bone.tail)))
    moved = Character(character.name, tuple(bones), character.scale)
    return moved, plain_map(moved)


def solved(
    character: Character,
    character_map: CharacterMap,
    source: SegmentMotion,
    options: RetargetOptions | None = None,
    object_space: Similarity | None = None,
) -> CharacterMotion:
    """The motion on a character whose object stands at the origin unless another place is given."""
    space = object_space or Similarity(np.eye(3), np.zeros(3), character.scale)
    return run(solve_motion(character, character_map, source, options or RetargetOptions(), space))


def joints(character_map: CharacterMap, motion: CharacterMotion) -> dict[str, Array]:
    """(F, 3) joints by role in the world [m]."""
    return {
        role: motion.to_world.to_world(motion.poses[bones.bones[0]][:, :3, 3])
        for role, bones in character_map.roles.items()
        if bones.bones[0] in motion.poses
    }


def soles(character: Character, character_map: CharacterMap, motion: CharacterMotion) -> dict[str, Array]:
    """(F, N, 3) soles by role of foot and toe in the world [m]."""
    found = {}
    for role, points in motion.soles.items():
        bone = character.bone(character_map.bones(role)[0])
        local = (points - bone.head) @ bone.rest[:3, :3]
        pose = motion.poses[bone.name]
        found[role] = motion.to_world.to_world(
            local @ np.swapaxes(pose[:, :3, :3], -1, -2) + pose[:, None, :3, 3]
        )
    return found


def source_joints(source: SegmentMotion) -> dict[str, Array]:
    """(F, 3) the performer's joints by role in the world [m]."""
    return {name.replace("girdle", "shoulder"): path for name, path in source.start.items()}


def quality(
    character: Character, character_map: CharacterMap, source: SegmentMotion, motion: CharacterMotion
) -> Quality:
    """Figures of a solved motion."""
    return measured(
        source_joints(source), motion, joints(character_map, motion), soles(character, character_map, motion)
    ).quality


# --- Motions as a network of somebody else's gives them: jittering, biased for a while, badly placed


RATE = 30.0
HIPS = [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]
ANKLES = [HUMAN.point_names.index(f"ankle.{side}") for side in "LR"]
MHR = {"head": ("left_ear", "right_ear")}


def about_hips(points: Array) -> Array:
    """Points (F, 13, 3) relative to the hips' middle."""
    return np.asarray(points - points[:, HIPS].mean(axis=1, keepdims=True))


def seen_by_network(points: Array, seed: int = 0, bias_m: float = 0.03, place_m: float = 0.04) -> Array:
    """Points whose error wanders (AR(1), 0.4 s) and is partly new in each frame, and whose place jumps."""
    rng = np.random.default_rng(seed)
    keep = np.exp(-1.0 / (RATE * 0.4))
    bias = np.zeros(points.shape)
    bias[0] = bias_m * rng.normal(size=points.shape[1:])
    for frame in range(1, len(points)):
        fresh = bias_m * np.sqrt(1.0 - keep**2) * rng.normal(size=points.shape[1:])
        bias[frame] = keep * bias[frame - 1] + fresh
    grain = 0.004 * rng.normal(size=points.shape)
    place = place_m * rng.normal(size=(len(points), 1, 3)) * [0.2, 1.0, 0.2]
    return np.asarray(points + bias + grain + place)


def jitter_mm(points: Array) -> float:
    """Mean length of second differences."""
    return 1e3 * float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=-1).mean())


def error_mm(points: Array, truth: Array) -> float:
    """Mean distance of points from true ones, about the hips."""
    return 1e3 * float(np.linalg.norm(about_hips(points) - about_hips(truth), axis=-1).mean())


def write_mhr70(path: Path, points: Array) -> None:
    """A csv like MHR-70's, in a camera's axes."""
    columns: dict[str, Array] = {}
    for index, name in enumerate(HUMAN.point_names):
        stem, dot, side = name.partition(".")
        names = (f"{'left' if side == 'L' else 'right'}_{stem}",) if dot else MHR[name]
        columns |= dict.fromkeys(names, points[:, index])
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow([f"{name}_3D{axis}" for name in columns for axis in "XYZ"])
        for frame in range(len(points)):
            places = [columns[name][frame] for name in columns]
            rows.writerow([f"{value:.6f}" for x, y, z in places for value in (x, -z, y)])


# --- Postures within their joint limits, cameras around them, and what is asked of a corrected pose


BODY = Body(Actor.from_stature(1.75))
COLUMN = {name: i for i, name in enumerate(HUMAN.dof_names)}
POINT = {name: i for i, name in enumerate(HUMAN.point_names)}


def natural_posture(seed: int, share: float = 0.7) -> Posture:
    """A posture anywhere in the inner share of its joint limits, near the origin and facing anywhere."""
    rng = np.random.default_rng(seed)
    lower, upper = HUMAN.limits.T
    vector = np.zeros(HUMAN.dof_count)
    bounded = np.isfinite(lower)
    lower, upper = lower[bounded], upper[bounded]
    middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
    vector[bounded] = middle + share * half * rng.uniform(-1.0, 1.0, int(bounded.sum()))
    vector[:6] = [*rng.normal(0.0, 0.2, 2), 1.0, 0.0, 0.0, rng.uniform(-np.pi, np.pi)]
    return Posture.from_vector(HUMAN, vector)


def camera_around(seed: int) -> Camera:
    """A camera at 3 to 6 m in any direction, from knee height to above the head, which looks at the body."""
    rng = np.random.default_rng(seed)
    angle, away, height = rng.uniform(0.0, 2.0 * np.pi), rng.uniform(3.0, 6.0), rng.uniform(0.5, 2.5)
    return camera_at(np.array([away * np.sin(angle), -away * np.cos(angle), height]))


def camera_at(eye: Array) -> Camera:
    """A camera at a place (3,) that looks at the body's middle."""
    back = eye - np.array([0.0, 0.0, 1.0])
    back /= np.linalg.norm(back)
    right = np.cross([0.0, 0.0, 1.0], back)
    right /= np.linalg.norm(right)
    matrix = np.eye(4)
    matrix[:3] = np.column_stack([right, np.cross(back, right), back, eye])
    return Camera(35.0, 36.0, (1280, 720), matrix)


def points(posture: Posture) -> Array:
    """(13, 3) the principal points [m]."""
    return BODY.points(BODY.pose(posture))


def pixels(posture: Posture, camera: Camera) -> Array:
    """(13, 2) their images [px]."""
    return camera.project(points(posture))[0]


def segment_lengths(posture: Posture) -> Array:
    """Length of every segment of a posture [m]."""
    pose = BODY.pose(posture)
    ends = [BODY.segment_ends(pose, segment.name) for segment in HUMAN.segments]
    return np.array([np.linalg.norm(end - start) for start, end in ends])


def beyond_limits_rad(posture: Posture) -> Array:
    """(D,) how far each degree of freedom is beyond its limits [m, rad]."""
    values = posture.to_vector()
    lower, upper = HUMAN.limits.T
    return np.abs(values - np.clip(values, lower, upper))


# --- Reviews of numbers that are made up


def made_up_review(frames: int = 13, first: float = 1.0) -> Review:
    """F frames of two markers: confidence falls towards the middle, one marker is hidden for some frames."""
    rng = np.random.default_rng(4)
    middle = np.sin(np.pi * np.arange(frames) / (frames - 1))
    observed = rng.normal(size=(frames, 2, 8, 2))
    observed[2, 1] = np.nan
    return Review(
        frames=np.arange(frames) + first,
        size=(160, 120),
        marker_names=("trunk", "Ärmel"),
        point_names=HUMAN.point_names,
        observed=observed,
        predicted=rng.normal(size=(frames, 2, 12, 2)),
        points=rng.normal(size=(frames, 13, 3)),
        image_points=rng.normal(size=(frames, 13, 2)),
        sigma_m=0.01 + 0.02 * middle[:, None] * rng.uniform(0.5, 1.0, size=(frames, 13)),
        speed=5.0 + 3.0 * middle,
        confidence=1.0 - 0.6 * middle,
        keyframe_indices=np.array([0, frames - 1]),
        weak_frames=(WeakFrame(frames // 2, Reason.HIDDEN, 1.0, 1), WeakFrame(3, Reason.FAR, 0.25)),
        contours=rng.uniform(20.0, 100.0, size=(frames, 6, 4, 2)),
        keypoints=made_up_keypoints(frames),
        unsure=np.arange(frames)[:, None] == [1, 2, 3],
    )


def made_up_keypoints(frames: int = 13) -> ComparedKeypoints:
    """F frames of a wrist and a knee of one source, and the same wrist of another, a pixel from the motion.

    The first wrist is thrown out in frame 1, hidden in frame 2, and taken for the other one in frame 4.
    """
    seen = np.random.default_rng(5).uniform(20.0, 100.0, size=(frames, 3, 2))
    seen[2, 0] = np.nan
    predicted, thrown_out, swapped = seen + [1.0, 0.0], *np.zeros((2, frames, 3), dtype=bool)
    predicted[1, 0] += 30.0
    thrown_out[1, 0], swapped[4, 0] = True, True
    score = np.where(np.isfinite(seen[..., 0]), 0.9, 0.0)
    distance, expected = np.linalg.norm(seen - predicted, axis=-1), np.full((frames, 3), 2.0)
    names, sources = ("wrist.L", "knee.R", "wrist.L"), ("a detector", "a detector", "Blender's tracks")
    return ComparedKeypoints(names, sources, seen, predicted, score, distance, expected, thrown_out, swapped)
