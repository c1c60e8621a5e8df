"""What stands before the performer, learned from pictures that were drawn from a known motion."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from _filmed import FRAME, FRAMES, POSED, TRUTH, album, photograph
from _scene import BODY, CAMERA, SEGMENTS, film, point_error_m
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.estimate.contour_evidence import ContourEvidence, learn_contours
from keymark.core.estimate.occluder_evidence import learn_occluders
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.footage.clips.album import Album
from keymark.core.observation.contours import ContourModel
from keymark.core.observation.occluders import StaticOccluders
from keymark.core.observation.part_map import part_map
from keymark.core.prior.interpolation import interpolate
from keymark.core.prior.keyframes import Keyframe
from keymark.core.progress import run

STEP_S = np.full(FRAMES - 1, 1.0 / 30.0)
TABLE = slice(150, 205), slice(120, 220)
"""Rows and columns; the shins move behind it."""
COLOR = (40.0, 110.0, 160.0)


def furnished(moving: bool = False) -> Album:
    """The pictures with a table before the performer, or a box that goes with it."""
    rng = np.random.default_rng(8)
    grain = cv2.resize(rng.normal(0.0, 5.0, size=(14, 25, 1)), (100, 55), interpolation=cv2.INTER_NEAREST)
    changed = Album()
    for frame in range(FRAMES):
        image = album().picture(frame).copy()
        left = 150 + round(60.0 * np.sin(frame / 5.0))
        where = (TABLE[0], slice(left, left + 40)) if moving else TABLE
        shade = COLOR + grain[..., None] + rng.normal(0.0, 2.0, size=(55, 100, 3))
        shade = shade[:, : where[1].stop - where[1].start]
        image[where] = np.clip(shade, 0, 255).astype(np.uint8)
        changed.add(frame, image)
    return changed


def contours(pictures: Album, posture: Posture = TRUTH) -> ContourEvidence:
    """What is learned of performer and background."""
    found = run(learn_contours(BODY, CAMERA, pictures, posture, POSED))
    assert found is not None
    return found


def learn(pictures: Album, posture: Posture = TRUTH) -> StaticOccluders | None:
    """What is found to stand before the performer."""
    return run(learn_occluders(contours(pictures, posture), posture, POSED, STEP_S))


def wobbling(degree: str, size: float, frames: np.ndarray = FRAME) -> Posture:
    """The true motion with a joint that errs in some frames."""
    step = np.zeros((FRAMES, HUMAN.dof_count))
    step[frames, HUMAN.dof_names.index(degree)] = size
    return TRUTH.plus(step)


def test_a_table_before_the_shins_is_found() -> None:
    """Where shins were behind it, and hardly anything of what is beside it."""
    found = learn(furnished())
    assert found is not None and found.factor == 1
    inside = np.zeros(found.covered.shape, dtype=bool)
    inside[TABLE] = True
    assert np.count_nonzero(found.covered & inside) > 300
    assert np.count_nonzero(found.covered & ~inside) < 0.03 * np.count_nonzero(found.covered)
    assert (found.hidden_from[found.covered] < 4.2).all()


def test_before_nothing_nothing_is_found() -> None:
    """Nor by postures of which a limb errs for some frames: it is seen beside."""
    assert learn(album()) is None
    assert learn(album(), wobbling("shoulder.L.rotation_y", 0.5, np.arange(18, 26))) is None
    assert learn(album(), wobbling("hip.L.rotation_y", 0.3, np.arange(3, 12))) is None


def test_what_moves_is_no_static_occluder() -> None:
    """A box that goes about before the performer hides it now here, now there."""
    found = learn(furnished(moving=True))
    assert found is None or np.count_nonzero(found.covered) < 50


def test_the_body_may_go_before_it() -> None:
    """Seen before the table at 3 m and behind it at 4.2 m, it is hidden from a depth between them."""
    step = np.zeros((FRAMES, HUMAN.dof_count))
    near = FRAME >= FRAMES // 2
    step[near, HUMAN.dof_names.index("pelvis.location_y")] = -1.2
    posture = TRUTH.plus(step)
    drawn, shown = photograph(posture), furnished()
    model = ContourModel.average(BODY, CAMERA)
    parts = model.part_outlines(BODY.pose(posture), FRAME)
    pictures = Album()
    for frame in range(FRAMES):
        image = drawn.picture(frame).copy()
        free = part_map(parts, frame, (320, 240), 1.0) < 0 if near[frame] else np.ones((240, 320), dtype=bool)
        table = np.zeros_like(free)
        table[TABLE] = True
        image[free & table] = shown.picture(frame)[free & table]
        pictures.add(frame, image)
    found = learn(pictures, posture)
    assert found is not None
    depth = found.hidden_from[found.covered]
    assert 2.9 < np.median(depth) < 4.1
    pixel = np.argwhere(found.covered)[len(depth) // 2][::-1] + 0.5
    share = found.visible_share(np.array([pixel, pixel]), np.array([2.7, 4.3]))
    assert share[0] > 0.9 and share[1] < 0.2


def solved(pictures: Album, hidden: np.ndarray, earlier: WholeClipResult | None = None) -> WholeClipResult:
    """The estimate where the shins' markers are cut off by the table, or gone."""
    keyframes = tuple(Keyframe(int(index), TRUTH[index : index + 1][0]) for index in POSED)
    tracks = film(TRUTH, 0.3)
    seen = np.where(hidden, np.nan, 1.0)
    tracks = replace(
        tracks,
        centroid=tracks.centroid * seen[..., None],
        second_moment=tracks.second_moment * seen[..., None, None],
        area=tracks.area * seen,
        quality=np.where(hidden, 0.0, tracks.quality),
    )
    prior = interpolate(keyframes, FRAMES)
    indices = tuple(int(index) for index in POSED)
    job = estimate_whole_clip(BODY, CAMERA, tracks, SEGMENTS, prior, indices, album=pictures, earlier=earlier)
    return run(job)


def test_the_estimate_keeps_what_it_found_for_the_next() -> None:
    """It is learned once: an estimate that starts from an earlier one has its map."""
    hidden = np.zeros((FRAMES, len(SEGMENTS)), dtype=bool)
    hidden[:, 3:] = True
    first = solved(furnished(), hidden)
    map_found = first.evidence.model.occluders
    assert map_found is not None and first.contours is not None
    assert first.contours.model.occluders is map_found
    again = solved(furnished(), hidden, first)
    assert again.evidence.model.occluders is map_found
    assert point_error_m(again.posture, first.posture).max() < 1e-9


def test_without_furniture_the_estimate_knows_none() -> None:
    """The map is None, and the postures are near the truth."""
    result = solved(album(), np.zeros((FRAMES, len(SEGMENTS)), dtype=bool))
    assert result.evidence.model.occluders is None
    assert point_error_m(result.posture, TRUTH).mean() < 0.05


def test_before_a_background_that_moves_there_is_nothing_to_learn_from() -> None:
    """No background is trusted, hence no map either."""
    shaken = photograph(TRUTH, shake_px=4)
    result = solved(shaken, np.zeros((FRAMES, len(SEGMENTS)), dtype=bool))
    assert result.contours is None and result.evidence.model.occluders is None


@pytest.mark.parametrize("keyframes", [POSED[:1], POSED])
def test_it_is_the_same_every_time(keyframes: np.ndarray) -> None:
    """Bit for bit, whatever was learned before."""
    evidence = contours(furnished())
    one, other = (run(learn_occluders(evidence, TRUTH, keyframes, STEP_S)) for _ in range(2))
    assert one is not None and other is not None
    np.testing.assert_array_equal(one.hidden_from, other.hidden_from)
