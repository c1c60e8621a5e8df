"""A second look at drawn pictures for markers that tracking has lost."""

from dataclasses import replace
from functools import cache

import numpy as np
from _filmed import FRAMES, POSED, TRUTH, photograph
from _scene import BODY, CAMERA, MODEL, SEGMENTS, film
from keymark.core.body.body_volume import body_pieces
from keymark.core.body.posture import Posture
from keymark.core.estimate.seen_tracks import seen_tracks
from keymark.core.estimate.whole_clip import WholeClipResult, estimate_whole_clip
from keymark.core.footage.clips.album import Album
from keymark.core.footage.ignored_regions import IgnoredPixels, IgnoredRegion
from keymark.core.footage.region_tracks import RegionTracks
from keymark.core.prior.interpolation import interpolate
from keymark.core.prior.keyframes import Keyframe
from keymark.core.progress import run

MARKER = SEGMENTS.index("forearm.L")
LOST = np.arange(20, 25)
EXPOSED = 7
"""Moments of one exposure."""


def blurred(frames: np.ndarray) -> Album:
    """The album of the true motion, with some frames exposed over two frames' time."""
    sharp, album = photograph(TRUTH), Album()
    moving = {}
    for frame in frames.tolist():
        around = np.linspace(-1.0, 1.0, EXPOSED)
        step = TRUTH[frame + 1 : frame + 2].minus(TRUTH[frame - 1 : frame]) / 2.0
        swept = photograph(TRUTH[np.full(EXPOSED, frame)].plus(around[:, None] * step))
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
    """Tracks that miss the left forearm in the lost frames."""
    tracks = film(TRUTH, 0.3)
    centroid, second, area, quality = (
        getattr(tracks, name).copy() for name in ("centroid", "second_moment", "area", "quality")
    )
    centroid[LOST, MARKER], second[LOST, MARKER], area[LOST, MARKER] = np.nan, np.nan, np.nan
    quality[LOST, MARKER] = 0.0
    return replace(tracks, centroid=centroid, second_moment=second, area=area, quality=quality)


def posed(off: float = 0.0) -> tuple[Keyframe, ...]:
    """Few keyframes, the last of them off by an angle of the elbow."""
    error = np.zeros((1, TRUTH.skeleton.dof_count))
    error[0, TRUTH.skeleton.dof_names.index("elbow.R.flexion")] = off
    exact = [Keyframe(int(index), TRUTH[index : index + 1][0]) for index in POSED]
    last = TRUTH[POSED[-1] : POSED[-1] + 1].plus(error)[0]
    return (*exact[:-1], Keyframe(int(POSED[-1]), last))


def estimate(
    album: Album,
    keyframes: tuple[Keyframe, ...] = posed(),
    earlier: WholeClipResult | None = None,
    ignored: IgnoredPixels | None = None,
) -> WholeClipResult:
    """The estimate from tracks that miss a marker."""
    prior = interpolate(keyframes, FRAMES)
    index = tuple(keyframe.index for keyframe in keyframes)
    return run(
        estimate_whole_clip(
            BODY,
            CAMERA,
            tracked(),
            SEGMENTS,
            prior,
            index,
            album=album,
            earlier=earlier,
            ignored=ignored,
        )
    )


@cache
def found() -> WholeClipResult:
    """The estimate from blurred pictures."""
    return estimate(pictures())


def finds(result: WholeClipResult) -> np.ndarray:
    """(F, M) what was found beyond the tracks."""
    problem = result.problem
    return np.isfinite(problem.observed.area) & np.isnan(problem.tracked.area)


def test_a_blurred_marker_is_found_where_it_is() -> None:
    """In most of the frames, within two pixels, and nothing else is; the posture follows."""
    new = finds(found())
    assert new[LOST, MARKER].sum() >= 3
    true = MODEL.evaluate(BODY.pose(TRUTH), np.arange(FRAMES)).centroid
    off = np.linalg.norm(found().problem.observed.centroid - true, axis=-1)
    assert off[new].max() < 2.0
    new[LOST, MARKER] = False
    hidden = MODEL.evaluate(BODY.pose(TRUTH), np.arange(FRAMES)).visible < 0.1
    assert not (new & hidden).any()
    quality = found().problem.observed.quality
    assert (quality[finds(found())] > 0.0).all() and quality.max() <= 1.0


def test_nothing_is_found_of_a_marker_that_is_not_there() -> None:
    """The sleeve pushed up: the forearm has the color of the upper arm."""
    names = [piece.segment for piece in body_pieces(BODY)]
    bare = photograph(TRUTH, recolored={names.index("forearm.L"): names.index("upper_arm.L")})
    worn, album = photograph(TRUTH), Album()
    for frame in range(FRAMES):
        album.add(frame, (bare if frame in LOST else worn).picture(frame))
    assert not finds(estimate(album))[LOST, MARKER].any()


def test_ignored_pixels_are_no_marker() -> None:
    """With the whole picture ignored in those frames nothing is found."""
    everywhere = IgnoredRegion(box=(0.0, 0.0, 320.0, 240.0), frames=(int(LOST[0]), int(LOST[-1])))
    ignored = IgnoredPixels((everywhere,), CAMERA.resolution)
    assert not finds(estimate(pictures(), ignored=ignored))[LOST, MARKER].any()


def test_finds_are_kept_where_nothing_changed() -> None:
    """A keyframe changed at the end: the same finds to the last digit, though the album is empty by then."""
    again = estimate(pictures(), posed(0.05), found())
    before, after = found().problem, again.problem
    assert again.evidence is not found().evidence and finds(again)[LOST, MARKER].any()
    first = POSED[-2]
    np.testing.assert_array_equal(after.observed.centroid[:first], before.observed.centroid[:first])
    np.testing.assert_array_equal(after.tracked.area, before.tracked.area)


def test_a_result_shows_what_was_found() -> None:
    """The tracks of a result hold the finds, with their quality; what was tracked stays."""
    tracks, observed = tracked(), found().problem.observed
    shown, new = seen_tracks(tracks, observed), finds(found())
    np.testing.assert_array_equal(shown.centroid[new], observed.centroid[new])
    np.testing.assert_array_equal(shown.quality[~new], tracks.quality[~new])
    assert shown.visible.sum() == tracks.visible.sum() + new.sum()


def test_the_posture_follows_what_was_found() -> None:
    """The wrist is nearer to the truth in the lost frames than without pictures of them."""
    empty = Album()
    for frame in sorted(set(range(FRAMES)) - set(LOST.tolist())):
        empty.add(frame, photograph_of(frame))
    without = estimate(empty).posture
    assert wrist_error(found().posture) < wrist_error(without)


def photograph_of(frame: int) -> np.ndarray:
    """A frame's picture."""
    return pictures().picture(frame)


def wrist_error(posture: Posture) -> float:
    """Mean distance of the left wrist from its true place in the lost frames [m]."""
    wrist = TRUTH.skeleton.point_names.index("wrist.L")
    points = [BODY.points(BODY.pose(one[LOST]))[:, wrist] for one in (posture, TRUTH)]
    return float(np.linalg.norm(points[0] - points[1], axis=-1).mean())
