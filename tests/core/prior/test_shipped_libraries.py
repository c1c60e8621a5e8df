"""The shipped libraries: complete, and such as people move.

They are data: who improves one loads it in Blender, saves it, and has it judged here.
"""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from _libraries import ACTOR, sample_motion
from keymark.core.arrays import Array
from keymark.core.body.kinematics import Body, Pose
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion, read_library

SHIPPED = Path(__file__).resolve().parents[3] / "presets" / "keyframes"
KINDS = {"aerobic", "balance", "jumping", "kicking", "punching", "reaching", "running", "squatting_lifting"}
KINDS |= {"turning", "walking", "waving"}
NAMES = sorted(KINDS)
BODY = Body(ACTOR)
DEEPEST_M = 0.03
"""A sole may dip so deep between two postures."""
SLIDES_M = {"walking": 0.01, "running": 0.01}
MOST_SLIDE_M = 0.03
FASTEST_MPS = {"ankle": 14.0, "wrist": 13.0}
HEEL, BALL = (0.0, 0.29, -0.36), (0.0, -0.66, -0.36)
"""Points of the sole relative to the ankle, in lengths of the foot."""
TRUNK_RADIUS_M = (0.15, 0.105)
"""Half the trunk's width and depth between waist and chest."""


@cache
def shipped(name: str) -> Library:
    return read_library(SHIPPED / f"{name}.json")


def over_time(library: Library, motion: LibraryMotion, rate_hz: float = 60.0) -> tuple[Posture, Array]:
    """Postures along one pass of a motion, and their times (T,) [s]."""
    times = np.arange(0.0, motion.duration_s + 1e-9, 1.0 / rate_hz)
    return sample_motion(library, motion, Body(library.actor), times), times


def ranges_left(library: Library) -> list[str]:
    """Every posture's degrees of freedom beyond their range."""
    found = []
    for name, posture in library.by_name.items():
        skeleton = posture.posture.skeleton
        values, limits = posture.posture.to_vector(), skeleton.limits
        beyond = np.maximum(limits[:, 0] - values, values - limits[:, 1])
        found += [
            f"{name}: {skeleton.dof_names[i]} by {np.degrees(beyond[i]):.0f} degrees"
            for i in np.flatnonzero(beyond > 0.0)
        ]
    return found


def soles(body: Body, pose: Pose) -> Array:
    """(..., 2) heights of the soles [m], left first; a foot is as flat as its ankle's position allows.

    The skeleton's foot is rigid with the shin, a person's is not: one that would dip into the floor is flat.
    """
    lengths = body.actor.segments_m
    heights = []
    for side in ("L", "R"):
        joint = body.skeleton.joint_index(f"shin.{side}")
        ankle = pose.place(joint, np.array([0.0, 0.0, -lengths[f"shin.{side}"]]))
        turns = pose.rotation[..., joint, :, :]
        places = [turns @ (lengths[f"foot.{side}"] * np.array(place)) for place in (HEEL, BALL)]
        rigid = np.min([place[..., 2] for place in places], axis=0)
        flat = lengths[f"foot.{side}"] * HEEL[2]
        heights.append(ankle[..., 2] + np.maximum(rigid, flat))
    return np.stack(heights, axis=-1)


def slides(body: Body, posture: Posture, times: Array, low_m: float = 0.02) -> float:
    """Largest drift of an ankle at rest, low over the floor and slow [m]."""
    pose = body.pose(posture)
    heights = soles(body, pose)
    worst = 0.0
    for column, side in enumerate(("L", "R")):
        point = body.skeleton.point_names.index(f"ankle.{side}")
        place = body.points(pose)[..., point, :2]
        speed = np.linalg.norm(np.gradient(place, times, axis=0), axis=-1)
        rests = (heights[:, column] < low_m) & (speed < 0.25)
        for run in np.split(np.flatnonzero(rests), np.flatnonzero(np.diff(np.flatnonzero(rests)) > 1) + 1):
            if len(run) >= 6:
                middle = place[run[len(run) // 4 : -len(run) // 4 or None]]
                worst = max(worst, float(np.linalg.norm(middle - middle.mean(axis=0), axis=-1).max()))
    return worst


def arms_in_trunk(body: Body, posture: Posture, limb_radius_m: float = 0.03) -> Array:
    """(...,) depth of an elbow, a wrist or a hand in the trunk, as a share of its radius; 0 is outside."""
    pose = body.pose(posture)
    deepest = np.zeros(posture.batch)
    chest, pelvis = (body.skeleton.joint_index(name) for name in ("waist", "pelvis"))
    for side in ("L", "R"):
        places = [*body.segment_ends(pose, f"forearm.{side}"), body.segment_ends(pose, f"hand.{side}")[1]]
        for joint in (chest, pelvis):
            top = body.actor.segments_m["trunk"] * (0.6 if joint == chest else 0.4)
            for place in places:
                away = (place - pose.origin[..., joint, :])[..., None]
                x, y, z = np.moveaxis(
                    (np.swapaxes(pose.rotation[..., joint, :, :], -1, -2) @ away)[..., 0], -1, 0
                )
                wide, deep = (radius + limb_radius_m for radius in TRUNK_RADIUS_M)
                beside = np.hypot(x / wide, y / deep)
                inside = np.where((z > 0.0) & (z < top), 1.0 - beside, 0.0)
                deepest = np.maximum(deepest, inside)
    return np.asarray(deepest)


def test_every_kind_is_shipped() -> None:
    assert {file.stem for file in SHIPPED.glob("*")} == KINDS
    assert all(shipped(name).identifier == name for name in NAMES)


@pytest.mark.parametrize("name", NAMES)
def test_a_library_says_what_it_is(name: str) -> None:
    library = shipped(name)
    used = {step.posture for motion in library.motions for step in motion.steps}
    assert 10 <= len(library.postures) <= 40
    assert used == set(library.by_name)
    assert library.license == "CC0-1.0" and library.author and library.description and library.tags
    assert len(library.sources) >= 2
    assert all(any(year in source for year in ("(19", "(20")) for source in library.sources)


@pytest.mark.parametrize("name", NAMES)
def test_joints_stay_in_their_range(name: str) -> None:
    assert ranges_left(shipped(name)) == []


@pytest.mark.parametrize("name", NAMES)
def test_feet_bear_the_body(name: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    for motion in library.motions:
        postures, times = over_time(library, motion)
        lowest = soles(body, body.pose(postures)).min(axis=-1)
        assert -DEEPEST_M < lowest.min() < DEEPEST_M, motion.name
        assert slides(body, postures, times) < SLIDES_M.get(name, MOST_SLIDE_M), motion.name


@pytest.mark.parametrize("name", NAMES)
def test_nobody_moves_faster_than_people(name: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    for motion in library.motions:
        postures, times = over_time(library, motion)
        points = body.points(body.pose(postures))
        speed = np.linalg.norm(np.gradient(points, times, axis=0), axis=-1)
        for joint, fastest in FASTEST_MPS.items():
            columns = [i for i, point in enumerate(body.skeleton.point_names) if point.startswith(joint)]
            assert speed[:, columns].max() < fastest, f"{motion.name}: {joint}"
        assert arms_in_trunk(body, postures).max() < 0.5, motion.name


@pytest.mark.parametrize(
    ("name", "motion"),
    [("walking", "walk"), ("walking", "brisk walk"), ("running", "jog"), ("running", "run")],
)
def test_the_second_step_mirrors_the_first(name: str, motion: str) -> None:
    library = shipped(name)
    body = Body(library.actor)
    cycle = next(candidate for candidate in library.motions if candidate.name == motion)
    times = np.linspace(0.0, 0.5 * cycle.duration_s, 12)
    first = sample_motion(library, cycle, body, times)
    second = mirrored(sample_motion(library, cycle, body, times + 0.5 * cycle.duration_s))
    on = Posture(
        first.skeleton,
        second.translation - 0.5 * np.array([cycle.travel[0], cycle.travel[1], 0.0]),
        second.rotations,
        second.angles,
    )
    away = np.linalg.norm(body.points(body.pose(first)) - body.points(body.pose(on)), axis=-1)
    assert away.max() < 0.01


def test_knees_bend_as_gait_laboratories_measure() -> None:
    library = shipped("walking")
    body = Body(library.actor)
    walk = library.motions[0]
    column = body.skeleton.dof_names.index("knee.L.flexion")
    shares = np.array([0.0, 0.14, 0.40, 0.60, 0.72])
    postures = sample_motion(library, walk, body, shares * walk.duration_s)
    knee = np.degrees(postures.to_vector()[:, column])
    assert np.all(np.abs(knee - [5.0, 18.0, 7.0, 38.0, 61.0]) < 8.0), knee


@pytest.mark.parametrize(
    "name", ["aerobic", "squatting_lifting", "reaching", "waving", "punching", "balance"]
)
def test_people_begin_and_end_in_standing(name: str) -> None:
    library = shipped(name)
    standing = library.by_name["standing"].posture
    at = dict(zip(BODY.skeleton.point_names, BODY.points(BODY.pose(standing)), strict=True))
    assert at["head"][2] > 1.5
    assert np.hypot(*(at["head"] - at["ankle.L"])[:2]) < 0.2
    assert any(
        "standing" in (motion.steps[0].posture, motion.steps[-1].posture) for motion in library.motions
    )
