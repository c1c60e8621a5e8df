"""What whole motions of the libraries tell of single parts."""

from pathlib import Path

import numpy as np
import pytest
from _performed import BODY, camera, filmed, performed
from keymark.core.body.human import LIMBS
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import headings_rad, yawed_at
from keymark.core.poses.clip_input import posing_input
from keymark.core.poses.library_motion import nearest_libraries, part_beliefs
from keymark.core.poses.part_features import (
    HEADINGS,
    TRUNK_POINTS,
    StanceFeatures,
    limb_points,
    stance_features,
)
from keymark.core.poses.part_pools import part_pools
from keymark.core.poses.plausibility import known_postures
from keymark.core.prior.library import Library, read_library
from keymark.core.progress import run
from keymark.core.session.stages import seen_in

HEADING = np.radians(30.0)


@pytest.fixture(scope="module")
def waving(repository: Path) -> Library:
    return read_library(repository / "presets" / "keyframes" / "waving.json")


def test_libraries_are_ordered_by_their_nearest_postures(
    walking: Library, squatting: Library, waving: Library
) -> None:
    walk = performed(walking, HEADING)
    elsewhere = yawed_at(walk, np.full(len(walk.translation), 2.0), walk.translation + 3.0)
    pools = part_pools([waving, squatting, walking], BODY)
    for posture in (walk, elsewhere):
        assert nearest_libraries(pools, posture)[0] == 2
    assert nearest_libraries(pools, performed(waving, HEADING))[0] == 0


def test_known_postures_face_ahead_with_their_mirror_images_behind_them(
    walking: Library, waving: Library
) -> None:
    known = known_postures(BODY, [walking, waving])
    count = len(walking.postures) + len(waving.postures)
    np.testing.assert_allclose(headings_rad(known.posture), 0.0, atol=1e-9)
    np.testing.assert_allclose(known.posture.translation[:, :2], 0.0, atol=1e-12)
    points = BODY.points(BODY.pose(known.posture))
    other = BODY.points(BODY.pose(mirrored(known.posture[np.arange(count)])))
    np.testing.assert_allclose(points[count:], other, atol=1e-9)
    assert list(known.mirrored) == [False] * count + [True] * count


def test_a_known_motion_makes_the_parts_it_shows_likelier(walking: Library, waving: Library) -> None:
    truth = performed(walking, HEADING)
    take, reading = filmed(truth, camera())
    given = posing_input(seen_in(take, reading))
    pools = part_pools([waving, walking], BODY)
    stances = stance_features(pools, given.evidence)
    beliefs = run(part_beliefs(given, stances, truth, truth.translation[given.sampled], 0.0))
    assert len(beliefs) == len(given.sampled)
    for belief, frame in zip(beliefs, given.sampled, strict=True):
        points = BODY.points(BODY.pose(truth[frame])) - truth.translation[frame]
        likeliest = int(belief.stance.argmin())
        trunk = stances.features.points[likeliest, TRUNK_POINTS]
        assert np.linalg.norm(trunk - points[TRUNK_POINTS], axis=-1).mean() < 0.15
        limbs = {limb: int(cost.argmin()) for limb, cost in belief.limbs.items()}
        for limb in LIMBS:
            own = _placed(stances, limb, likeliest, limbs[limb])
            assert np.linalg.norm(own - points[limb_points(limb)], axis=-1).mean() < 0.25
            assert belief.limbs[limb].max() <= 0.0
        behind = (likeliest // HEADINGS) * HEADINGS + (likeliest + HEADINGS // 2) % HEADINGS
        assert belief.stance[behind] > 0.4 * belief.stance[likeliest]


def test_a_motion_that_fits_badly_is_believed_little(walking: Library, waving: Library) -> None:
    truth = performed(walking, HEADING)
    take, reading = filmed(truth, camera())
    given = posing_input(seen_in(take, reading))
    hips = truth.translation[given.sampled]
    most = []
    for library in (walking, waving):
        pools = part_pools([library], BODY)
        stances = stance_features(pools, given.evidence)
        beliefs = run(part_beliefs(given, stances, truth, hips, 0.0))
        most.append(np.mean([belief.limbs["leg.L"].min() for belief in beliefs]))
    assert most[0] < 1.5 * most[1] < 0.0


def _placed(stances: StanceFeatures, limb: str, stance: int, part: int) -> np.ndarray:
    """(2, 3) points of a limb's part on a stance, from the hips."""
    turn, origin = stances.frame_of(limb, np.array([stance]))
    return np.asarray(stances.limbs[limb].points[part] @ turn[0].T + origin[0])
