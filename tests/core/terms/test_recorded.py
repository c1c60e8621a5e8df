"""What postures predict of the footage, number by number: regions, contours, keypoints, line ends."""

from dataclasses import replace

import numpy as np
import pytest
from _recorded import assert_recorded
from _scene import BODY, CAMERA, MODEL, SEGMENTS, detect, exercise, film
from keymark.core.camera.camera import Camera
from keymark.core.detect.keypoints import BODY_POINTS
from keymark.core.estimate.line_ends import LineEnds, angle_weight, observed_characteristics, residual
from keymark.core.terms.contours import ContourModel, LimbAxes, part_map
from keymark.core.terms.depths import DepthLinks, depths_jacobian, point_depths
from keymark.core.terms.head import ASIDE_RAD, BEHIND_RAD, PRESENT, ObservedHeads
from keymark.core.terms.keypoints import KeypointModel
from keymark.core.terms.occlusion import outline_depth
from keymark.core.terms.reference import ExpectedPoints
from keymark.core.terms.region_model import RegionModel
from keymark.core.terms.regions import ObservedRegions, feature_rows, limb_widths, missing_variance

FRAMES = 12
FRAME = np.arange(FRAMES)
POSE = BODY.pose(exercise(5 * FRAMES)[2::5])
NEAR = np.array([[1.0, 0, 0, 0.35], [0, 0, -1, -1.9], [0, 1, 0, 1.3], [0, 0, 0, 1]])
CAMERAS = {"far": CAMERA, "cutting": Camera(40.0, 36.0, (320, 240), NEAR)}
"""The second one sees a part of the body, which the picture's edges cut."""


@pytest.mark.parametrize("name", CAMERAS)
def test_regions(name: str) -> None:
    model = RegionModel(BODY, CAMERAS[name], MODEL.placements)
    seen = model.evaluate(POSE, FRAME, jacobian=True)
    assert_recorded(f"regions {name}", seen.centroid, seen.second_moment)
    assert_recorded(f"area {name}", seen.area, 1e3 * seen.visible)
    observed = ObservedRegions.from_tracks(film(exercise(FRAMES), 0.4, model=MODEL))
    rows, slopes = feature_rows(observed, seen)
    assert slopes is not None
    assert_recorded(f"rows {name}", rows)
    assert_recorded(f"slopes {name}", slopes)
    assert_recorded(f"missing {name}", missing_variance(observed.area, np.ones(len(SEGMENTS)), seen))
    assert_recorded(f"widths {name}", limb_widths(model, BODY.points(POSE)[:, 0], FRAME))


@pytest.mark.parametrize("name", CAMERAS)
def test_contours(name: str) -> None:
    model = ContourModel.average(BODY, CAMERAS[name])
    model = replace(model, shape=np.linspace(-0.01, 0.02, model.shape.size).reshape(model.shape.shape))
    seen = model.evaluate(POSE, FRAME)
    for field in ("world", "pixel", "depth", "normal", "half_width", "shape_rate"):
        assert_recorded(f"contours {name} {field}", getattr(seen, field))
    assert_recorded(f"contours {name} slopes", model.normal_jacobian(seen, seen.normal, POSE))
    parts = model.part_outlines(POSE, FRAME)
    drawn = [part_map(parts, frame, (80, 60), 4.0) for frame in (0, 5)]
    # OpenCV's releases round a border's pixels differently.
    assert_recorded(f"parts {name}", *drawn, share=0.05)
    assert_recorded(f"outline depth {name}", outline_depth(seen.pixel, parts))
    axes = LimbAxes(model.parts, CAMERAS[name])
    share = np.linspace(0.1, 0.9, FRAMES * len(model.parts.segments)).reshape(FRAMES, -1)
    world, pixel = axes.points(POSE, FRAME, share)
    direction = np.stack([np.cos(share), np.sin(share)], axis=-1)
    assert_recorded(f"axes {name}", pixel, axes.jacobian(POSE, FRAME, world, direction), axes.beyond)


def test_keypoints_and_depths() -> None:
    model = KeypointModel.usual(BODY, CAMERA, BODY_POINTS)
    links = DepthLinks.between(BODY_POINTS, ("one",) * len(BODY_POINTS))
    assert_recorded("keypoints", model.pixels(POSE, FRAME))
    assert_recorded("keypoints, slopes", model.pixels_jacobian(POSE, FRAME))
    assert_recorded("links", links.depths(model, POSE, FRAME), links.jacobian(model, POSE, FRAME))
    assert_recorded("links, lengths", links.lengths_m(model))
    assert_recorded("depths", point_depths(BODY, CAMERA, POSE, FRAME))
    assert_recorded("depths, slopes", depths_jacobian(BODY, CAMERA, POSE, FRAME))


def test_line_ends() -> None:
    ends = LineEnds(BODY, CAMERA, SEGMENTS)
    predicted = ends.evaluate(POSE, FRAME)
    observed = observed_characteristics(film(exercise(FRAMES), 0.4))
    assert_recorded("line ends", predicted)
    assert_recorded("line ends, residual", residual(observed, predicted))
    assert_recorded("angle weight", angle_weight(np.linspace(-1.0, 3.0, 9)))


def test_heads_of_faces_and_points() -> None:
    """Faces ahead, aside, turned away and unsure, one not looked at; points in space of all but one head."""
    keypoints = detect(exercise(FRAMES), names=BODY_POINTS, hint_error_m=0.01)
    aside = [0.0, 0.5 * ASIDE_RAD, ASIDE_RAD - 0.01, ASIDE_RAD + 0.01, BEHIND_RAD - 0.01, BEHIND_RAD + 0.01]
    face = np.zeros((FRAMES, 6))
    face[:, :2], face[:6, 3], face[:, 4] = keypoints.pixel[:, 0], aside, 0.1
    face[:, 5] = np.where(FRAME % 4 == 3, PRESENT - 0.01, PRESENT + 0.01)
    face[8] = np.nan
    hint = np.random.default_rng(2).normal(0.0, 0.1, keypoints.hint_m.shape)
    hint[3] = np.nan
    heads = ObservedHeads.of(replace(keypoints, face=face, hint_m=hint), CAMERA)
    assert heads is not None
    assert_recorded("heads", heads.turn[heads.seen], np.where(heads.seen, heads.std_rad, 0.0))


def test_reference_points_that_differ() -> None:
    points = np.random.default_rng(3).normal(size=(4, 13, 3))
    one = ExpectedPoints(points, np.full((4, 13, 3, 3), np.eye(3)), 0.4)
    moved, wider = points.copy(), one.whitening.copy()
    moved[1, 4, 2] += 1.5e-3
    moved[2, 4, 2] += 0.5e-3
    wider[3, 7] *= np.exp(0.06)
    np.testing.assert_array_equal(one.differ(replace(one, points=moved)), FRAME[:4] == 1)
    np.testing.assert_array_equal(one.differ(replace(one, whitening=wider)), FRAME[:4] == 3)
    wider[3, 7] *= np.exp(-0.02)
    assert not one.differ(replace(one, whitening=wider)).any()
