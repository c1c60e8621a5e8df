"""Predicted regions and their silhouettes."""

from dataclasses import fields, replace

import numpy as np
import pytest
from _scene import BODY, CAMERA, MODEL, SEGMENTS, exercise, film
from keymark.core.body.body_volume import Piece, PieceStack
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.camera.camera import Camera
from keymark.core.terms import region_model
from keymark.core.terms.occlusion import sample_silhouette, view_pieces
from keymark.core.terms.region_model import MOMENTS, MarkerPlacement, RegionModel
from keymark.core.terms.regions import FEATURES, ObservedRegions, feature_rows, missing_variance

STEP = 1e-5
FRAMES = 6


def standing(**angles: float) -> Posture:
    """The rest posture at standing height with some degrees of freedom set."""
    vector = np.zeros((1, HUMAN.dof_count))
    vector[0, 2] = 0.95
    for name, value in angles.items():
        vector[0, HUMAN.dof_names.index(name.replace("__", "."))] = value
    return Posture.from_vector(HUMAN, vector)


def predict(posture: Posture, jacobian: bool = False):  # noqa: ANN201
    return MODEL.evaluate(BODY.pose(posture), np.arange(posture.batch[0]), jacobian)


def test_a_stretched_forearm_lies_where_it_projects() -> None:
    posture = standing()
    seen = predict(posture)
    elbow, wrist = (CAMERA.project(end)[0][0] for end in BODY.segment_ends(BODY.pose(posture), "forearm.L"))
    sleeve = MODEL.placements[1]
    first, last = (elbow + share * (wrist - elbow) for share in (sleeve.first, sleeve.last))
    length = np.linalg.norm(last - first)
    np.testing.assert_allclose(seen.centroid[0, 1], 0.5 * (first + last), atol=0.06 * length)
    assert seen.second_moment[0, 1, 0, 0] == pytest.approx(length**2 / 12, rel=0.08)
    assert seen.second_moment[0, 1, 1, 1] < 0.25 * seen.second_moment[0, 1, 0, 0]
    assert seen.visible[0].min() > 0.95


def test_moving_away_shrinks_a_region_with_the_square_of_distance() -> None:
    near, far = standing(), standing(pelvis__location_y=4.2)
    ratio = predict(near).area[0] / predict(far).area[0]
    np.testing.assert_allclose(ratio, 4.0, rtol=0.12)


@pytest.mark.parametrize("seed", range(5))
def test_jacobians_agree_with_central_differences_where_nothing_hides(
    seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(region_model, "visible_share", lambda pixels, depth, parts, own: np.ones(depth.shape))
    rng = np.random.default_rng(seed)
    posture = standing().plus(0.15 * rng.normal(size=(1, HUMAN.dof_count)))
    seen = predict(posture, jacobian=True)
    steps = STEP * np.eye(HUMAN.dof_count)
    sides = [[predict(posture.plus(sign * step)) for sign in (1.0, -1.0)] for step in steps]
    centroid = np.stack([(a.centroid - b.centroid)[0] for a, b in sides], axis=-1) / (2 * STEP)
    moment = np.stack([(a.second_moment - b.second_moment)[0] for a, b in sides], axis=-1) / (2 * STEP)
    moment = np.stack([moment[:, a, b] for a, b in MOMENTS], axis=1)
    assert seen.centroid_jacobian is not None and seen.moment_jacobian is not None
    for marker in range(len(SEGMENTS)):
        for ours, theirs, share in (
            (seen.centroid_jacobian[0, marker], centroid[marker], 0.03),
            (seen.moment_jacobian[0, marker], moment[marker], 0.20),
        ):
            assert np.linalg.norm(ours - theirs) < share * np.linalg.norm(theirs)


def test_an_arm_before_the_trunk_hides_part_of_it_and_is_not_hidden_itself() -> None:
    across = standing(**{"shoulder.L.rotation_y": 1.1, "shoulder.L.rotation_z": -0.9, "elbow.L.flexion": 1.2})
    open_arm, crossed = predict(standing()), predict(across)
    assert crossed.visible[0, 0] < open_arm.visible[0, 0] - 0.05
    assert crossed.visible[0, 1] > 0.8


def test_a_forearm_behind_the_back_is_hidden_and_keeps_finite_moments() -> None:
    behind = standing(**{"shoulder.L.rotation_y": 1.3, "shoulder.L.rotation_z": 1.0, "elbow.L.flexion": -1.6})
    seen = predict(behind, jacobian=True)
    assert seen.visible[0, 1] < 0.1
    assert np.isfinite(seen.centroid).all() and np.isfinite(seen.second_moment).all()
    assert seen.centroid_jacobian is not None and np.isfinite(seen.centroid_jacobian).all()


def test_a_long_clip_is_predicted_as_its_frames_are(monkeypatch: pytest.MonkeyPatch) -> None:
    posture = exercise(9)
    whole = predict(posture, jacobian=True)
    monkeypatch.setattr(region_model, "PIECES_AT_ONCE", 2 * len(SEGMENTS))
    stretched = predict(posture, jacobian=True)
    for field in fields(whole):
        np.testing.assert_allclose(getattr(stretched, field.name), getattr(whole, field.name), atol=1e-8)


def test_a_placement_further_down_moves_the_region_down_the_limb() -> None:
    stocking = MarkerPlacement("shin.L", 0.05, 0.95)
    sock = MarkerPlacement("shin.L", 0.5, 0.95)
    pose = BODY.pose(standing())
    frame = np.arange(1)
    high, low = (
        RegionModel(BODY, CAMERA, (placement,)).evaluate(pose, frame).centroid[0, 0, 1]
        for placement in (stocking, sock)
    )
    assert low > high + 3.0


def test_markers_are_predicted_in_the_order_given() -> None:
    posture = standing()
    pose = BODY.pose(posture)
    seen = predict(posture).centroid[0, 1:]
    middles = np.array(
        [
            CAMERA.project(0.5 * sum(BODY.segment_ends(pose, name)))[0][0]  # type: ignore[arg-type]
            for name in SEGMENTS[1:]
        ]
    )
    nearest = np.linalg.norm(seen[:, None] - middles[None], axis=-1).argmin(axis=1)
    np.testing.assert_array_equal(nearest, np.arange(len(middles)))


def shifted(shift: float) -> RegionModel:
    """The model before a camera whose picture ends elsewhere."""
    return RegionModel(BODY, replace(CAMERA, shift_x=shift), MODEL.placements)


def test_the_edge_of_the_picture_cuts_a_region() -> None:
    posture = standing()
    pose, frame = BODY.pose(posture), np.zeros(1, dtype=np.intp)
    whole = predict(posture)
    middle = whole.centroid[0, 1, 0]
    model = shifted((middle - CAMERA.resolution[0]) / CAMERA.resolution[0])  # to the picture's right edge
    cut, edge = model.evaluate(pose, frame), CAMERA.resolution[0]
    assert cut.visible[0, 1] == pytest.approx(0.5 * whole.visible[0, 1], abs=0.08)
    half = np.sqrt(12.0 * whole.second_moment[0, 1, 0, 0]) / 2.0
    assert cut.centroid[0, 1, 0] == pytest.approx(edge - half / 2.0, abs=0.1 * half)
    assert cut.second_moment[0, 1, 0, 0] == pytest.approx(0.25 * whole.second_moment[0, 1, 0, 0], rel=0.3)
    np.testing.assert_allclose(cut.area[0, 3:], whole.area[0, 3:])  # the legs are inside


def test_slopes_at_the_edge_are_those_of_what_is_left() -> None:
    posture = standing(shoulder__L__rotation_y=0.2)
    middle = predict(posture).centroid[0, 1, 0]
    model = shifted((middle - CAMERA.resolution[0]) / CAMERA.resolution[0])
    frame, column = np.zeros(1, dtype=np.intp), HUMAN.dof_names.index("pelvis.location_x")
    step = 1e-4 * np.eye(HUMAN.dof_count)[column : column + 1]
    sides = [model.evaluate(BODY.pose(posture.plus(sign * step)), frame).centroid for sign in (1.0, -1.0)]
    slope = (sides[0] - sides[1])[0, :, 0] / 2e-4
    seen = model.evaluate(BODY.pose(posture), frame, jacobian=True)
    assert seen.centroid_jacobian is not None
    ours = seen.centroid_jacobian[0, :, 0, column]
    assert ours[1] == pytest.approx(slope[1], rel=0.05)
    assert slope[1] < 0.7 * slope[3]  # of a shin, all of which is inside


def test_what_has_left_the_picture_is_not_seen() -> None:
    model = shifted(-0.9)
    seen = model.evaluate(BODY.pose(standing()), np.zeros(1, dtype=np.intp), jacobian=True)
    assert seen.visible.max() == 0.0
    assert np.isfinite(seen.centroid).all() and np.isfinite(seen.moment_jacobian).all()


LENGTH, WIDE, DEEP = 0.4, 0.12, 0.05
FRAME = np.zeros(1, dtype=np.intp)


def upright(first: float = 1.0, last: float = 1.0) -> PieceStack:
    """An upright cylinder at the hips, with given half-widths at either end."""
    widths = np.array([[WIDE, DEEP]]) * np.array([[first], [last]])
    return PieceStack.of(
        [
            Piece(
                "trunk",
                0,
                np.array([0.0, 0.0, -LENGTH / 2]),
                np.array([0.0, 0.0, LENGTH / 2]),
                np.array([1.0, 0.0, 0.0]),
                np.array([0.0, 1.0, 0.0]),
                widths,
            )
        ]
    )


def at_camera_height(turn: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Posture:
    """The hips at the camera's height, turned by a rotation vector."""
    vector = np.zeros((1, HUMAN.dof_count))
    vector[0, 2] = 1.0
    vector[0, 3:6] = turn
    return Posture.from_vector(HUMAN, vector)


def seen(pieces: PieceStack, posture: Posture, camera: Camera = CAMERA):  # noqa: ANN201
    pose = BODY.pose(posture)
    return sample_silhouette(pieces, view_pieces(pieces, pose, camera, FRAME))


def test_a_cylinder_from_the_front_fills_a_rectangle() -> None:
    samples = seen(upright(), at_camera_height())
    area = samples.area[0, 0]
    assert area.sum() == pytest.approx(2 * WIDE * LENGTH, rel=1e-3)
    place = samples.world[0, 0]
    weight = area / area.sum()
    assert weight @ place[:, 2] == pytest.approx(1.0, abs=1e-6)
    assert weight @ place[:, 0] ** 2 == pytest.approx(WIDE**2 / 3, rel=0.08)
    assert weight @ (place[:, 2] - 1.0) ** 2 == pytest.approx(LENGTH**2 / 12, rel=0.03)


def test_a_cylinder_from_above_shows_its_elliptical_end() -> None:
    samples = seen(upright(), at_camera_height((np.pi / 2, 0.0, 0.0)))
    assert samples.area[0, 0].sum() == pytest.approx(np.pi * WIDE * DEEP, rel=1e-2)


@pytest.mark.parametrize("yaw", [0.3, 0.8, np.pi / 2])
def test_a_turned_trunk_shows_the_width_of_its_ellipse(yaw: float) -> None:
    samples = seen(upright(), at_camera_height((0.0, 0.0, yaw)))
    half = np.hypot(WIDE * np.cos(yaw), DEEP * np.sin(yaw))
    assert samples.area[0, 0].sum() == pytest.approx(2 * half * LENGTH, rel=1e-3)


@pytest.mark.parametrize("seed", range(6))
def test_area_rates_agree_with_central_differences(seed: int) -> None:
    rng = np.random.default_rng(seed)
    far = Camera(4000.0, 36.0, (320, 240), CAMERA.matrix_world - 400 * np.outer([0, 1, 0, 0], [0, 0, 0, 1]))
    base = at_camera_height(tuple(rng.normal(size=3) * 0.8))
    rate = seen(upright(0.6, 1.0), base, far).area_rate[0, 0].sum(0)
    step = 1e-6
    for axis in range(3):
        # A world rotation w acts on the body's own tangent as Rᵀ w.
        tangent = np.zeros((1, HUMAN.dof_count))
        tangent[0, 3:6] = base.rotations[0, 0].T[:, axis] * step
        ahead, behind = (
            seen(upright(0.6, 1.0), base.plus(sign * tangent), far).area[0, 0].sum() for sign in (1, -1)
        )
        assert rate[axis] == pytest.approx((ahead - behind) / (2 * step), abs=2e-4)


def test_features_of_a_region_against_itself_are_zero_and_grow_with_its_shift() -> None:
    posture = exercise(FRAMES)
    tracks = film(posture)
    predicted = MODEL.evaluate(BODY.pose(posture), np.arange(FRAMES))
    observed = ObservedRegions.from_tracks(tracks)
    residual, _ = feature_rows(observed, predicted)
    seen = tracks.visible
    assert residual.shape[-1] == FEATURES
    assert np.abs(residual[seen]).max() < 1e-9
    elsewhere = replace(observed, centroid=observed.centroid - [3.0, 0.0])
    shifted, _ = feature_rows(elsewhere, predicted)
    np.testing.assert_allclose(shifted[seen][:, 0], 3.0)
    np.testing.assert_allclose(shifted[seen][:, 1:], 0.0, atol=1e-9)


def test_a_shape_residual_is_the_difference_of_deviations_in_pixels() -> None:
    posture = exercise(1)
    predicted = MODEL.evaluate(BODY.pose(posture), np.arange(1))
    tracks = film(posture)
    observed = ObservedRegions.from_tracks(tracks)
    stretched = (
        observed.axes @ np.apply_along_axis(np.diag, -1, [1.0, 1.1]) @ np.swapaxes(observed.axes, -1, -2)
    )
    moment = stretched @ observed.second_moment @ np.swapaxes(stretched, -1, -2)
    wider = replace(tracks, second_moment=moment)
    residual, _ = feature_rows(ObservedRegions.from_tracks(wider), predicted)
    long_axis = observed.deviation[0, :, 1]
    np.testing.assert_allclose(residual[0, :, 4], -0.1 * long_axis, rtol=0.06)


def test_what_is_missing_of_a_region_widens_its_features() -> None:
    predicted = MODEL.evaluate(BODY.pose(exercise(1)), np.arange(1))
    variance = [missing_variance(share * predicted.area, 1.0, predicted) for share in (1.0, 0.5, 0.25)]
    assert variance[0].max() == 0.0
    along = np.sqrt(predicted.second_moment[..., 0, 0])
    assert np.all(np.sqrt(variance[1][..., 0]) > 0.4 * along)
    assert np.all(variance[2] > variance[1])
