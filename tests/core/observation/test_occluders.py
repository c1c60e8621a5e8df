"""What a map of static occluders hides of points, of regions and of contours."""

import numpy as np
from _scene import BODY, CAMERA, MODEL, exercise
from keymark.core.observation.occluders import StaticOccluders
from keymark.core.observation.regions import LEAST_SHOWN, RegionModel

FACTOR = 2


def table(top_px: int, hidden_from_m: float = 3.0) -> StaticOccluders:
    """Everything from a row of the picture on downwards is hidden, from a depth on."""
    hidden = np.full((120, 160), np.inf, dtype=np.float32)
    hidden[top_px // FACTOR :] = hidden_from_m
    return StaticOccluders(hidden, FACTOR)


def before(occluders: StaticOccluders) -> RegionModel:
    """The scene's markers behind something."""
    return RegionModel(BODY, CAMERA, MODEL.placements, occluders)


def test_a_point_is_hidden_behind_the_map_and_neither_beside_nor_before_it() -> None:
    """Outside the picture nothing is hidden, and a point that is no number is in nobody's way."""
    seen = table(140)
    pixels = np.array([[80.0, 200.0], [80.0, 60.0], [80.0, 200.0], [80.0, 900.0], [np.nan, np.nan]])
    depth = np.array([4.0, 4.0, 2.0, 4.0, 4.0])
    np.testing.assert_allclose(seen.visible_share(pixels, depth), [0.0, 1.0, 1.0, 1.0, 1.0], atol=1e-3)


def test_the_edge_is_soft() -> None:
    """Across it the visible share falls steadily, within a few pixels of the map."""
    rows = np.arange(130.0, 150.0, 0.5)
    share = table(140).visible_share(
        np.stack([np.full_like(rows, 80.5), rows], axis=-1), np.full(len(rows), 4.0)
    )
    assert (np.diff(share) <= 0.0).all() and share[0] > 0.99 and share[-1] < 0.01
    assert np.count_nonzero((share > 0.05) & (share < 0.95)) >= 4


def test_a_table_hides_the_lower_part_of_a_shin() -> None:
    """What is left is smaller and lies higher; what is not behind it, or nearer, is as it was."""
    posture, frame = exercise(1), np.arange(1)
    pose = BODY.pose(posture)
    free = MODEL.evaluate(pose, frame)
    shin = 3
    middle = round(float(free.centroid[0, shin, 1]))
    behind = before(table(middle)).evaluate(pose, frame)
    assert 0.3 < behind.area[0, shin] / free.area[0, shin] < 0.7
    assert behind.visible[0, shin] == behind.shown[0, shin] < 0.75
    assert behind.centroid[0, shin, 1] < free.centroid[0, shin, 1] - 3.0
    np.testing.assert_allclose(behind.centroid[0, :3], free.centroid[0, :3], atol=1e-6)
    nearer = before(table(middle, 9.0)).evaluate(pose, frame)
    np.testing.assert_allclose(nearer.centroid, free.centroid, atol=1e-6)


def test_a_region_that_the_map_hides_wholly_is_not_expected_but_compared_as_if_it_were_free() -> None:
    """A map is rough: a part that is seen after all still tells where the limb is."""
    pose, frame = BODY.pose(exercise(1)), np.arange(1)
    free = MODEL.evaluate(pose, frame, jacobian=True)
    hidden = before(table(0)).evaluate(pose, frame, jacobian=True)
    assert (hidden.shown < LEAST_SHOWN).all() and (free.shown > LEAST_SHOWN).all()
    np.testing.assert_allclose(hidden.visible, free.visible)
    np.testing.assert_allclose(hidden.centroid, free.centroid)
    assert hidden.centroid_jacobian is not None and free.centroid_jacobian is not None
    np.testing.assert_allclose(hidden.centroid_jacobian, free.centroid_jacobian)
