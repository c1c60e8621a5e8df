"""Contours and axes of limbs in the image."""

from dataclasses import replace

import numpy as np
from _scene import BODY, CAMERA, exercise
from keymark.core.body.human import HUMAN
from keymark.core.terms.contours import FREE, SHAPE, SHARES, SIDES, UNKNOWN, ContourModel, LimbAxes, part_map
from keymark.core.terms.occlusion import outline_depth

MODEL = ContourModel.average(BODY, CAMERA)
AXES = LimbAxes(MODEL.parts, CAMERA)
NAMES = MODEL.parts.segments
FRAME = np.arange(1)
STEP = 1e-5


def test_correcting_a_shape_moves_its_contours_as_predicted() -> None:
    pose = BODY.pose(exercise(1))
    before = MODEL.evaluate(pose, FRAME)
    for column in range(SHAPE):
        shape = np.zeros_like(MODEL.shape)
        shape[:, column] = 1e-3
        after = replace(MODEL, shape=shape).evaluate(pose, FRAME)
        moved = np.sum(before.normal * (after.pixel - before.pixel), axis=-1)
        np.testing.assert_allclose(moved, before.shape_rate[..., column] * 1e-3, atol=0.01)


def test_contours_lie_on_either_side_of_the_limb_and_point_outwards() -> None:
    predicted = MODEL.evaluate(BODY.pose(exercise(1)), FRAME)
    pairs = predicted.pixel[0].reshape(-1, len(SIDES), 2)
    normals = predicted.normal[0].reshape(-1, len(SIDES), 2)
    apart = pairs[:, 1] - pairs[:, 0]
    np.testing.assert_allclose(np.sum(normals[:, 0] * normals[:, 1], axis=-1), -1.0, atol=0.02)
    assert (np.sum(apart * normals[:, 1], axis=-1) > 0.0).all()
    width = predicted.half_width[0].reshape(-1, len(SIDES)).sum(axis=-1)
    np.testing.assert_allclose(np.linalg.norm(apart, axis=-1), width, rtol=0.08)


def test_the_map_shows_the_nearest_part() -> None:
    posture = exercise(1)
    vector = posture.to_vector()
    for name, value in (("shoulder.L.rotation_z", -1.4), ("elbow.L.flexion", 1.4)):
        vector[:, HUMAN.dof_names.index(name)] = value
    posture = posture.from_vector(HUMAN, vector)
    pose = BODY.pose(posture)
    parts = MODEL.part_outlines(pose, FRAME)
    labels = part_map(parts, 0, (320, 240), 1.0)
    for name in ("forearm.L", "shin.R", "head"):
        middle = 0.5 * sum(CAMERA.project(end)[0][0] for end in BODY.segment_ends(pose, name))
        column, row = middle.astype(int)
        assert NAMES[labels[row, column]] == name
        depth = outline_depth(middle[None, None], parts)[0, 0]
        assert depth.argmin() == NAMES.index(name)
    assert labels[5, 5] == -1
    assert 0.02 < np.mean(labels >= 0) < 0.2


def test_what_lies_beyond_a_part_is_its_own_side_s() -> None:
    beyond = dict(zip(NAMES, AXES.beyond.tolist(), strict=True))
    assert beyond["forearm.R"] == [NAMES.index("upper_arm.R"), NAMES.index("hand.R")]
    assert beyond["head"] == [NAMES.index("chest"), FREE]
    assert beyond["hand.L"][1] == beyond["foot.R"][1] == FREE
    assert beyond["upper_arm.L"][0] == UNKNOWN


def test_a_contour_lies_a_half_width_from_its_limb_s_own_place() -> None:
    pose = BODY.pose(exercise(1))
    world = MODEL.evaluate(pose, FRAME).world[0].reshape(len(NAMES), len(SHARES), len(SIDES), 3)
    for part, name in enumerate(NAMES):
        start, end = (point[0] for point in BODY.segment_ends(pose, name))
        if name.partition(".")[0] not in ("forearm", "shin", "thigh", "upper_arm"):
            continue
        along = (world[part].mean(axis=1) - start) @ (end - start) / ((end - start) @ (end - start))
        np.testing.assert_allclose(along, SHARES, atol=0.1)
        assert np.ptp(along) > 0.5 * np.ptp(SHARES)
