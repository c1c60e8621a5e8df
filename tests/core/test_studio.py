"""The studio's takes: people could move so, interpolation could not guess it, and the demonstration stays."""

import dataclasses
import sys
from pathlib import Path

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.body.posture_fit import fit_posture
from keymark.core.prior.keyframes import Keyframe, interpolate_linearly
from keymark.core.review.score import read_truth

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tools"))

from studio import curves  # noqa: E402
from studio.catalogue import DEMONSTRATION, GREETING, TAKES  # noqa: E402
from studio.described import Described, posed_frames  # noqa: E402
from studio.limbs import foot_clearance  # noqa: E402
from studio.look import MARKERS  # noqa: E402
from studio.performance import FPS, Performance, principal_points  # noqa: E402

OTHERS = [name for name in TAKES if name != DEMONSTRATION.name]
FASTEST_MPS = 14.0
"""Elite kicks and throws stay below, at the ankle and the wrist."""
BEYOND_LIMIT_RAD = np.radians(5.0)
BELOW_FLOOR_M = 0.04
"""A foot's mesh may dip so deep for a frame or two while it lands by angles."""


@pytest.fixture(scope="module")
def performances() -> dict[str, Performance]:
    """Every take's performance."""
    return {name: described.perform(described.seed) for name, described in TAKES.items()}


def _points(performance: Performance) -> Array:
    """(F, 13, 3) the true points."""
    return principal_points(performance, performance.middles)


@pytest.mark.parametrize("name", [DEMONSTRATION.name, GREETING.name])
def test_the_examples_are_still_composed_as_they_were(
    performances: dict[str, Performance], repository: Path, name: str
) -> None:
    points = _points(performances[name])
    truth = read_truth(repository / "presets" / "demo" / name / "truth.json", 1, len(points))
    assert np.abs(points - truth).max() < 1e-6


@pytest.mark.parametrize("name", OTHERS)
def test_joints_stay_in_their_range(performances: dict[str, Performance], name: str) -> None:
    performance = performances[name]
    values = performance.postures[performance.middles].to_vector()
    for joint in HUMAN.joints:
        if joint.limits_deg:
            columns = [HUMAN.dof_names.index(f"{joint.name}.{component}") for component in joint.components]
            lower, upper = np.radians(np.array(joint.limits_deg)).T
            beyond = np.maximum(values[:, columns] - upper, lower - values[:, columns])
            assert beyond.max() < BEYOND_LIMIT_RAD, joint.name


@pytest.mark.parametrize("name", OTHERS)
def test_nothing_is_faster_than_people_or_below_the_floor(
    performances: dict[str, Performance], name: str
) -> None:
    performance = performances[name]
    points = _points(performance)
    assert np.linalg.norm(np.diff(points, axis=0), axis=-1).max() * performance.fps < FASTEST_MPS
    for side, rotations in performance.feet.items():
        ankle = points[:, HUMAN.point_names.index(f"ankle.{side}"), 2]
        assert (ankle - foot_clearance(rotations[performance.middles])).min() > -BELOW_FLOOR_M


@pytest.mark.parametrize("name", OTHERS)
def test_keyframes_joined_by_constant_velocity_miss_the_motion(
    performances: dict[str, Performance], name: str
) -> None:
    performance, described = performances[name], TAKES[name]
    points = _points(performance)
    posed = described.posed_frames(len(points))
    postures = performance.postures[performance.middles]
    plain = interpolate_linearly([Keyframe(index, postures[index]) for index in posed], len(points))
    between = np.setdiff1d(np.arange(len(points)), posed)
    joined = performance.body.points(performance.body.pose(plain))
    assert np.linalg.norm(joined - points, axis=-1)[between].mean() > 0.03


@pytest.mark.parametrize("name", TAKES)
def test_the_camera_sees_the_performer(performances: dict[str, Performance], name: str) -> None:
    camera = TAKES[name].camera
    pixels, depth = camera.project(_points(performances[name]))
    inside = np.all((pixels > 0.0) & (pixels < np.array(camera.resolution)), axis=-1) & (depth > 0.0)
    assert inside.mean() > 0.97


@pytest.mark.parametrize("name", OTHERS)
def test_a_seed_decides_a_performance(performances: dict[str, Performance], name: str) -> None:
    again = TAKES[name].perform(TAKES[name].seed)
    other = TAKES[name].perform(TAKES[name].seed + 1)
    assert np.array_equal(_points(again), _points(performances[name]))
    assert np.abs(_points(other) - _points(again)).max() > 0.005


def test_takes_differ_from_each_other() -> None:
    described = list(TAKES.values())
    colors = {tuple(take.look.painted[marker] for marker in MARKERS) for take in described}
    assert len(colors) == len({take.seed for take in described}) == len(described)
    assert len({take.camera.resolution for take in described}) > 1
    assert len({take.camera.matrix_world.tobytes() for take in described}) == len(described)


@pytest.mark.parametrize("seed", range(5))
def test_posed_frames_are_spread_as_people_spread_them(seed: int) -> None:
    frames = posed_frames(110, np.random.default_rng(seed))
    gaps = np.diff(frames)
    assert (frames[0], frames[-1], len(frames)) == (0, 109, 12)
    assert gaps.min() >= 2 and gaps.max() <= 18 and len(set(gaps.tolist())) > 3


def test_a_demonstration_without_its_own_keyframes_would_get_chosen_ones() -> None:
    assert DEMONSTRATION.posed_frames(118)[:3] == (0, 8, 15)
    chosen: Described = dataclasses.replace(DEMONSTRATION, keyframes=())
    assert chosen.posed_frames(118) != DEMONSTRATION.keyframes


def test_a_fast_take_has_its_own_frame_rate(performances: dict[str, Performance]) -> None:
    throws = performances["throw60"]
    assert (throws.fps, performances["throw"].fps) == (60, FPS)
    slow = dataclasses.replace(throws, frame_count=throws.frame_count // 2, times=throws.times / 2.0, fps=30)
    per_second = [np.linalg.norm(np.diff(_points(p), axis=0), axis=-1).max() * p.fps for p in (throws, slow)]
    assert per_second[1] == pytest.approx(per_second[0], rel=0.1)


def test_a_build_moves_joints_but_no_feet(performances: dict[str, Performance]) -> None:
    performance = performances["martial"]
    assert performance.build is not None and performances["kick"].build is None
    pose = performance.body.pose(performance.postures[performance.middles])
    points, names = _points(performance), HUMAN.point_names
    beside = np.linalg.norm(points - performance.body.points(pose), axis=-1)
    assert 0.005 < beside.mean() < 0.015 and beside.max() < 0.03
    assert beside[:, [names.index("ankle.L"), names.index("ankle.R")]].max() < 1e-12
    for first, last, segment in (
        ("hip", "knee", "thigh"),
        ("knee", "ankle", "shin"),
        ("elbow", "wrist", "forearm"),
    ):
        ends = [points[:, names.index(f"{part}.L")] for part in (first, last)]
        length = np.linalg.norm(ends[1] - ends[0], axis=-1)
        assert np.abs(length - performance.body.actor.segments_m[f"{segment}.L"]).max() < 0.025


def test_no_posture_reaches_a_build(performances: dict[str, Performance]) -> None:
    performance = performances["martial"]
    residual = fit_posture(performance.body, _points(performance)[::20]).residual_m
    assert residual.mean(axis=-1).min() > 0.002
    assert residual.max(axis=-1).min() > 0.005


def test_a_mesh_follows_its_build(performances: dict[str, Performance]) -> None:
    performance = performances["martial"]
    body, build = performance.body, performance.build
    assert build is not None
    pose = body.pose(performance.postures[performance.middles])
    joints = {j.name: (pose.rotation[:, i], pose.origin[:, i]) for i, j in enumerate(HUMAN.joints)}
    placed, points = build.placed(body, pose, joints), _points(performance)
    for joint, start, end in (("hip.R", "hip.R", "knee.R"), ("knee.R", "knee.R", "ankle.R")):
        turn, place = placed[joint]
        first, last = (points[:, HUMAN.point_names.index(name)] for name in (start, end))
        along = (last - first) / np.linalg.norm(last - first, axis=-1, keepdims=True)
        assert place == pytest.approx(first, abs=1e-9)
        assert -turn[..., 2] == pytest.approx(along, abs=1e-6)


def test_flight_falls_as_bodies_fall() -> None:
    times = np.arange(0.0, 1.0, 0.01)
    height = curves.flight(times, 0.2, 0.7)
    inside = (times > 0.215) & (times < 0.685)
    bend = np.gradient(np.gradient(height, times), times)
    assert bend[inside][2:-2] == pytest.approx(-9.81, rel=1e-6)
    assert height[times < 0.19].max() == height[times > 0.71].max() == 0.0


def test_a_spring_is_late_overshoots_and_settles() -> None:
    times = np.arange(0.0, 3.0, 1.0 / 240.0)
    followed = curves.sprung((times > 0.5).astype(float), times, 4.0, 0.5)
    assert followed[times < 0.5].max() < 1e-9
    assert followed[(times > 0.5) & (times < 0.53)].max() < 0.5
    assert 1.1 < followed.max() < 1.25
    assert followed[-1] == pytest.approx(1.0, abs=1e-6)


def test_uneven_cycles_keep_their_mean_length() -> None:
    times = np.arange(0.0, 20.0, 0.01)
    phases = curves.uneven_phases(times, 0.5, 0.1, np.random.default_rng(3))
    assert np.diff(phases).min() > 0.0
    assert phases[-1] - phases[0] == pytest.approx(40.0, rel=0.1)
    lengths = np.diff(np.interp(np.arange(1.0, 36.0), phases, times))
    assert lengths.std() > 0.02
