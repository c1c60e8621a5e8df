"""A second look at drawn pictures for markers that tracking has lost."""

from dataclasses import replace
from functools import cache

import numpy as np
from _recorded import assert_recorded
from _scene import BODY, CAMERA, FRAMES, MODEL, POSED, SEGMENTS, TRUTH, film, photograph
from keymark.core.body.posture import Posture
from keymark.core.estimate.belief import Belief
from keymark.core.estimate.second_look import seen_tracks
from keymark.core.estimate.whole_clip import Seen, WholeClipResult, estimate_whole_clip
from keymark.core.markers.ignored_regions import IgnoredPixels, IgnoredRegion
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, interpolate
from keymark.core.progress import run
from keymark.core.video.album import Album

MARKER = SEGMENTS.index("forearm.R")
LOST = np.arange(20, 25)
WORN = {"forearm.R": (215.0, 60.0, 40.0)}
PUSHED_UP = {"forearm.R": (60.0, 60.0, 60.0)}
EXPOSED = 7
"""Moments of one exposure."""


def jerked() -> Posture:
    """The filmed motion with a jerk of the right arm that no keyframe shows."""
    step = np.zeros((FRAMES, BODY.skeleton.dof_count))
    jerk = 0.6 * np.sin(np.pi * np.clip((np.arange(FRAMES) - 17.0) / 10.0, 0.0, 1.0)) ** 2
    step[:, BODY.skeleton.dof_names.index("shoulder.R.rotation_y")] = jerk
    return TRUTH.plus(step)


MOTION = jerked()


@cache
def worn() -> Album:
    """The album of the true motion, every frame sharp."""
    return photograph(MOTION, painted=WORN)


def blurred(frames: np.ndarray) -> Album:
    """The album of the true motion, with some frames exposed over two frames' time."""
    sharp, album = worn(), Album()
    moving = {}
    for frame in frames.tolist():
        around = np.linspace(-1.0, 1.0, EXPOSED)
        step = MOTION[frame + 1 : frame + 2].minus(MOTION[frame - 1 : frame]) / 2.0
        swept = photograph(MOTION[np.full(EXPOSED, frame)].plus(around[:, None] * step), painted=WORN)
        pictures, _ = swept.pictures(range(EXPOSED))
        moving[frame] = pictures.astype(float).mean(axis=0).round().astype(np.uint8)
    for frame in range(FRAMES):
        album.add(frame, moving.get(frame, sharp.picture(frame)))
    return album


@cache
def pictures() -> Album:
    """The album in which the lost frames are blurred."""
    return blurred(LOST)


def tracked() -> RegionTracks:
    """Tracks that miss the right forearm in the lost frames."""
    tracks = film(MOTION, 0.3)
    centroid, second, area, quality = (
        getattr(tracks, name).copy() for name in ("centroid", "second_moment", "area", "quality")
    )
    centroid[LOST, MARKER], second[LOST, MARKER], area[LOST, MARKER] = np.nan, np.nan, np.nan
    quality[LOST, MARKER] = 0.0
    return replace(tracks, centroid=centroid, second_moment=second, area=area, quality=quality)


def estimate(album: Album, ignored: IgnoredPixels | None = None) -> WholeClipResult:
    """The estimate from few exact keyframes and tracks that miss a marker."""
    keyframes = tuple(Keyframe(int(index), MOTION[index : index + 1][0]) for index in POSED)
    belief = Belief.of(interpolate(keyframes, FRAMES), tuple(POSED.tolist()))
    seen = Seen(tracked(), SEGMENTS, album=album, ignored=ignored)
    return run(estimate_whole_clip(BODY, CAMERA, seen, belief))


def everywhere() -> IgnoredPixels:
    """The whole picture, in the lost frames."""
    whole = IgnoredRegion(box=(0.0, 0.0, 320.0, 240.0), frames=(int(LOST[0]), int(LOST[-1])))
    return IgnoredPixels((whole,), CAMERA.resolution)


@cache
def found() -> WholeClipResult:
    """The estimate from blurred pictures."""
    return estimate(pictures())


@cache
def without() -> WholeClipResult:
    """The estimate with the whole picture ignored in the lost frames."""
    return estimate(pictures(), ignored=everywhere())


def finds(result: WholeClipResult) -> np.ndarray:
    """(F, M) what was found beyond the tracks."""
    problem = result.problem
    return np.isfinite(problem.observed.area) & np.isnan(problem.data.tracked.area)


def test_a_blurred_marker_is_found_where_it_is() -> None:
    new = finds(found())
    assert new[LOST, MARKER].sum() >= 3
    seen = found().problem.observed
    assert_recorded("second look", seen.centroid, seen.second_moment, seen.area, share=1e-3)
    assert_recorded("second look, variance", seen.variance, seen.quality, share=1e-3)
    true = MODEL.evaluate(BODY.pose(MOTION), np.arange(FRAMES)).centroid
    off = np.linalg.norm(found().problem.observed.centroid - true, axis=-1)
    assert off[new].max() < 2.0
    new[LOST, MARKER] = False
    hidden = MODEL.evaluate(BODY.pose(MOTION), np.arange(FRAMES)).visible < 0.1
    assert not (new & hidden).any()
    quality = found().problem.observed.quality
    assert (quality[finds(found())] > 0.0).all() and quality.max() <= 1.0


def test_nothing_is_found_of_a_marker_that_is_not_there() -> None:
    bare, album = photograph(MOTION[LOST], painted=PUSHED_UP), Album()
    for frame in range(FRAMES):
        lost = frame in LOST
        album.add(frame, bare.picture(frame - LOST[0]) if lost else worn().picture(frame))
    assert not finds(estimate(album))[LOST, MARKER].any()


def test_ignored_pixels_are_no_marker() -> None:
    assert not finds(without())[LOST, MARKER].any()


def test_a_result_shows_what_was_found() -> None:
    tracks, observed = tracked(), found().problem.observed
    shown, new = seen_tracks(tracks, observed), finds(found())
    np.testing.assert_array_equal(shown.centroid[new], observed.centroid[new])
    np.testing.assert_array_equal(shown.quality[~new], tracks.quality[~new])
    assert shown.visible.sum() == tracks.visible.sum() + new.sum()


def test_the_posture_follows_what_was_found() -> None:
    assert wrist_error_px(found().posture) < 0.6 * wrist_error_px(without().posture)


def wrist_error_px(posture: Posture) -> float:
    """Mean distance of the right wrist from its true place in the lost frames [px]."""
    wrist = BODY.skeleton.point_names.index("wrist.R")
    points = [BODY.points(BODY.pose(one[LOST]))[:, wrist] for one in (posture, MOTION)]
    one, other = (CAMERA.project(point)[0] for point in points)
    return float(np.linalg.norm(one - other, axis=-1).mean())
