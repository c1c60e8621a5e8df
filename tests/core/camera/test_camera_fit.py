"""A camera found from lines, upright things, and moments in which the performer stands."""

from dataclasses import replace

import numpy as np
import pytest
from keymark.core.arrays import Array
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import standing_posture
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera, default_camera_pose
from keymark.core.camera.camera_evidence import CLICK_STD_PX, CameraEvidence, Uprights
from keymark.core.camera.camera_fields import CameraPlacement, heading_rad
from keymark.core.camera.camera_fit import HEIGHT, LENS, PARAMETERS, ROLL, TILT, CameraFit, fit_camera
from keymark.core.detect.keypoints import Keypoints
from keymark.core.detect.standing_moments import standing_keypoints

SIZE = (1280, 720)
STATURE_M = 1.75
UP = np.array([0.0, 0.0, 1.0])


def camera(lens_mm: float, height_m: float, tilt: float, roll: float) -> Camera:
    placement = CameraPlacement(height_m, float(np.radians(tilt)), float(np.radians(roll)))
    return Camera(lens_mm, 36.0, SIZE, placement.matrix())


def usual(lens_mm: float = 35.0) -> Camera:
    return Camera(lens_mm, 36.0, SIZE, default_camera_pose(lens_mm, 36.0, SIZE))


def lines(true: Camera, ends: Array) -> Array:
    return true.project(ends)[0]


def room(true: Camera, level: bool = True) -> CameraEvidence:
    """Two door frames, two lines on the floor that run away, one across, and someone between them."""
    plumb = np.array([[[x, 5.0, 0.0], [x, 5.0, 2.1]] for x in (-1.3, 1.5)])
    along = np.array([[[x, 3.5, 0.0], [x + 0.4, 6.0, 0.0]] for x in (-1.0, 1.0)])
    across = np.array([[[-1.0, 5.0, 0.0], [1.0, 4.68, 0.0]]])
    none = np.zeros((0, 2, 2))
    return CameraEvidence(
        lines(true, plumb),
        lines(true, along) if level else none,
        lines(true, across) if level else none,
        Uprights.things(*true.project([[0.0, 4.5, 0.0], [0.0, 4.5, 1.9]])[0], 1.9),
    )


def people(true: Camera, places: Array) -> Uprights:
    ground = np.column_stack([places, np.zeros(len(places))])
    return Uprights.persons(true.project(ground)[0], true.project(ground + STATURE_M * UP)[0], STATURE_M)


def errors(fit: CameraFit, true: Camera) -> dict[str, float]:
    known, found = CameraPlacement.of(true.matrix_world), fit.placement
    return {
        HEIGHT: found.height_m - known.height_m,
        TILT: found.tilt_rad - known.tilt_rad,
        ROLL: found.roll_rad - known.roll_rad,
        LENS: fit.camera.lens_mm - true.lens_mm,
    }


CAMERAS = [
    camera(40.0, 1.1, -9.0, 0.0),
    camera(28.0, 2.2, -20.0, 1.0),
    camera(58.0, 1.9, -12.0, 9.0),
    camera(30.0, 0.8, 8.0, -1.5),
]


@pytest.mark.parametrize("true", CAMERAS)
def test_exact_lines_give_the_exact_camera(true: Camera) -> None:
    fit = fit_camera(usual(), room(true))
    assert fit.kept == () and fit.misfit_px < 0.5
    for name, error in errors(fit, true).items():
        assert abs(error) < 0.3 * fit.std[name], name
    many = CameraEvidence(*(np.tile(each, (400, 1, 1)) for each in _three(room(true))), room(true).uprights)
    for name, error in errors(fit_camera(usual(), many), true).items():
        assert abs(error) < 0.02 * fit.std[name] + (0.01 if name == HEIGHT else 0.0), name


def _three(evidence: CameraEvidence) -> tuple[Array, Array, Array]:
    return evidence.vertical, evidence.along, evidence.across


def test_drawn_lines_are_as_far_off_as_stated() -> None:
    rng = np.random.default_rng(3)
    squared: dict[str, list[float]] = {name: [] for name in PARAMETERS}
    for true in CAMERAS:
        exact = room(true)
        for _ in range(5):
            drawn = [each + rng.normal(0.0, CLICK_STD_PX, each.shape) for each in _three(exact)]
            lower = exact.uprights.lower_px + rng.normal(0.0, CLICK_STD_PX, (1, 2))
            upper = exact.uprights.upper_px + rng.normal(0.0, CLICK_STD_PX, (1, 2))
            fit = fit_camera(usual(), CameraEvidence(*drawn, Uprights.things(lower, upper, 1.9)))
            for name, error in errors(fit, true).items():
                if name not in fit.kept:
                    squared[name].append((error / fit.std[name]) ** 2)
    for name in PARAMETERS:
        assert len(squared[name]) > 12 and 0.4 < np.mean(squared[name]) < 1.6, name


@pytest.mark.parametrize("true", CAMERAS)
def test_people_at_several_places_give_height_tilt_and_roll(true: Camera) -> None:
    rng = np.random.default_rng(8)
    places = np.array([[-1.0, 4.2], [1.0, 5.0], [0.0, 7.0], [-0.5, 5.5]])
    seen = people(true, places)
    shown = np.linalg.norm(seen.upper_px - seen.lower_px, axis=1)
    lean = rng.normal(0.0, 0.5 * np.stack([seen.lean_std_rad, seen.length_std], axis=1) * shown[:, None])
    standing = replace(seen, upper_px=seen.upper_px + lean)
    fit = fit_camera(usual(true.lens_mm), CameraEvidence(uprights=standing), lens_is_known=True)
    assert fit.kept == (LENS,) and fit.camera.lens_mm == pytest.approx(true.lens_mm)
    for name in (HEIGHT, TILT, ROLL):
        assert abs(errors(fit, true)[name]) < 3.0 * fit.std[name], name


def test_one_place_determines_the_height_only_with_the_tilt() -> None:
    true = camera(35.0, 1.4, 0.0, 0.0)
    fit = fit_camera(usual(), CameraEvidence(uprights=people(true, np.array([[0.0, 5.0]]))))
    assert LENS in fit.kept and {HEIGHT, TILT} & set(fit.kept)
    for name in fit.kept:
        assert errors(fit, usual())[name] == pytest.approx(0.0, abs=1e-9)
    assert fit.std[HEIGHT] > 0.1


def test_nothing_determines_nothing() -> None:
    before = usual()
    fit = fit_camera(before, CameraEvidence())
    assert fit.kept == PARAMETERS and np.allclose(fit.camera.matrix_world, before.matrix_world)
    assert fit.camera.lens_mm == pytest.approx(before.lens_mm) and fit.misfit_px == 0.0


def test_lines_too_near_each_other_leave_the_tilt_and_a_level_camera_the_lens() -> None:
    true = camera(50.0, 1.4, -2.0, 0.0)
    near = np.array([[[x, 5.0, 1.0], [x, 5.0, 1.3]] for x in (0.0, 0.03)])
    fit = fit_camera(usual(), CameraEvidence(vertical=lines(true, near)))
    assert {TILT, LENS, HEIGHT} <= set(fit.kept) and fit.placement.tilt_rad == pytest.approx(0.0, abs=1e-9)
    level = camera(50.0, 1.4, 0.0, 0.0)
    evidence = room(level)
    fit = fit_camera(usual(), CameraEvidence(evidence.vertical, evidence.along, uprights=evidence.uprights))
    assert fit.kept == (LENS,) and abs(errors(fit, level)[TILT]) < fit.std[TILT]


def test_lines_that_contradict_each_other_widen_the_deviations_and_say_so() -> None:
    true = camera(35.0, 1.5, -10.0, 0.0)
    plumb = np.array([[[x, 5.0, 0.0], [x, 5.0, 2.0]] for x in (-1.5, -0.7, 0.2, 0.9, 1.5)])
    good = fit_camera(usual(), CameraEvidence(vertical=lines(true, plumb)))
    plumb[2, 1, 0] += 0.6
    bad = fit_camera(usual(), CameraEvidence(vertical=lines(true, plumb)))
    assert good.excess < 1.5 and bad.excess > 10.0 and bad.misfit_px > 5.0
    assert bad.std[TILT] > 2.0 * good.std[TILT]


def test_place_and_heading_stay_and_distortion_is_heeded() -> None:
    placement = CameraPlacement(1.6, float(np.radians(-12.0)), 0.0)
    true = Camera(30.0, 36.0, SIZE, placement.matrix(), distortion=(-0.08, 0.01, 0.0))
    before = replace(true, lens_mm=33.0, matrix_world=CameraPlacement(1.3, 0.0, 0.0).matrix((3.0, -2.0), 1.1))
    fit = fit_camera(before, room(true))
    assert np.allclose(fit.camera.matrix_world[:2, 3], (3.0, -2.0))
    assert heading_rad(fit.camera.matrix_world) == pytest.approx(1.1)
    assert abs(errors(fit, true)[TILT]) < np.radians(0.7) and abs(errors(fit, true)[LENS]) < 1.5


BODY = Body(Actor.from_stature(1.8))
SMALL = (640, 480)
FPS = 30.0
TRUE = Camera(35.0, 36.0, SMALL, CameraPlacement(1.6, float(np.radians(-8.0)), 0.0).matrix())


def walk(count: int = 120) -> Array:
    """Principal points (F, 13, 3) of someone upright who glides to and fro and comes nearer."""
    phase = np.linspace(0.0, 2.0 * np.pi, count)
    places = np.column_stack([1.2 * np.sin(2.0 * phase), 5.5 + 1.5 * np.cos(phase), 0.0 * phase])
    return BODY.points(BODY.pose(Posture.stack([standing_posture(BODY, place) for place in places])))


def keypoints(points: Array, noise_px: float = 0.0) -> Keypoints:
    pixel = TRUE.project(points)[0]
    pixel = pixel + np.random.default_rng(1).normal(0.0, noise_px, pixel.shape)
    count = len(HUMAN.point_names)
    unknown = np.full((len(points), count, 3), np.nan)
    return Keypoints(HUMAN.point_names, ("x",) * count, pixel, np.ones(pixel.shape[:2]), unknown)


def before() -> Camera:
    return Camera(35.0, 36.0, SMALL, default_camera_pose(35.0, 36.0, SIZE))


def test_a_walk_finds_height_and_tilt() -> None:
    seen = standing_keypoints(keypoints(walk(), 2.0), BODY, FPS)
    assert 10 <= len(seen) <= 14 and seen.doubtful  # one in nine frames
    fit = fit_camera(before(), CameraEvidence(uprights=seen), lens_is_known=True)
    assert fit.kept == (LENS,)
    assert abs(fit.placement.height_m - 1.6) < min(2.0 * fit.std["height"], 0.15)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < min(2.0 * fit.std["tilt"], np.radians(2.0))


def test_who_bends_kneels_or_is_cut_off_is_no_measure() -> None:
    points = walk()
    names = list(HUMAN.point_names)
    upper = [
        i for i, name in enumerate(names) if name.split(".")[0] in ("head", "shoulder", "elbow", "wrist")
    ]
    bent = points.copy()
    hip = bent[:, names.index("hip.L")]
    bent[:, upper] = hip[:, None] + (bent[:, upper] - hip[:, None])[..., [2, 1, 0]]
    assert len(standing_keypoints(keypoints(bent), BODY, FPS)) == 0
    crouched = points.copy()
    crouched[:60, [names.index("ankle.L"), names.index("ankle.R")], 2] += 0.35
    assert len(standing_keypoints(keypoints(crouched), BODY, FPS)) <= 7
    seen = keypoints(points)
    feet = [names.index("ankle.L"), names.index("ankle.R")]
    score = np.array(seen.score)
    score[:, feet] = 0.1
    unsure = Keypoints(seen.names, seen.sources, seen.pixel, score, seen.hint_m)
    assert len(standing_keypoints(unsure, BODY, FPS)) == 0
    assert len(standing_keypoints(Keypoints.none(20), BODY, FPS)) == 0


def test_who_is_in_the_air_is_no_measure() -> None:
    points = walk(480)
    time_s = np.arange(len(points)) / FPS
    points[..., 2] += (4.9 * np.maximum(0.1 - (time_s % 2.0 - 1.0) ** 2, 0.0))[:, None]
    seen = standing_keypoints(keypoints(points), BODY, FPS)
    assert 16 <= len(seen) <= 40
    fit = fit_camera(before(), CameraEvidence(uprights=seen), lens_is_known=True)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < min(2.5 * fit.std["tilt"], np.radians(4.0))


def test_single_moments_far_off_change_little() -> None:
    points = walk()
    seen = standing_keypoints(keypoints(points, 1.0), BODY, FPS)
    lower = np.array(seen.lower_px)
    lower[::5] += 0.1 * (seen.upper_px - lower)[::5]
    wrong = type(seen)(
        lower, seen.upper_px, seen.lower_m, seen.length_m, seen.pixel_std, seen.length_std, seen.lean_std_rad,
        common_std=seen.common_std, common_lean_rad=seen.common_lean_rad, doubtful=True,
    )  # fmt: skip
    fit = fit_camera(before(), CameraEvidence(uprights=wrong), lens_is_known=True)
    assert abs(fit.placement.tilt_rad + np.radians(8.0)) < np.radians(2.5)
