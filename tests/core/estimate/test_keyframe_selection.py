"""Which matched keyframes are used beside posed ones."""

from dataclasses import replace

import numpy as np
from _scene import BODY, MODEL, exercise, film
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints, mirrored_point
from keymark.core.estimate.keyframe_selection import select_keyframes
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.prior.texts import COMPOSED
from keymark.core.terms.region_model import RegionModel

FRAMES, FPS = 91, 30.0
TRUTH = exercise(FRAMES)
TRACKS = film(TRUTH, 0.3)
SAID = Matched("walking", "step", False, 0.9)
DOFS = BODY.skeleton.dof_count
OF_ANGLES = np.where(np.arange(DOFS) < 3, 0.0, 1.0)


def used(posed: list[int], library: Posture) -> tuple[list[int], list[int]]:
    """Frames of the posed and of the matched keyframes that are left, of matched ones every 10 frames."""
    keyframes = [Keyframe(i, library[i], matched=SAID) for i in range(5, FRAMES, 10) if i not in posed]
    keyframes += [Keyframe(i, TRUTH[i]) for i in posed]
    left = select_keyframes(tuple(sorted(keyframes, key=lambda k: k.index)), MODEL, TRACKS, FPS)
    return [k.index for k in left if k.matched is None], [k.index for k in left if k.matched is not None]


def alike() -> Posture:
    """The motion as another performer does it: a little otherwise all along."""
    return TRUTH.plus(np.tile(0.04 * OF_ANGLES, (FRAMES, 1)))


def unlike() -> Posture:
    """Another motion: off by as much again and again, to all sides."""
    turns = np.sin(np.arange(FRAMES)[:, None] / 9.0 + np.arange(DOFS))
    return TRUTH.plus(1.2 * OF_ANGLES * turns)


def test_a_library_of_the_motion_is_used_between_posed_keyframes_that_are_far_apart() -> None:
    assert used([0, 90], alike()) == ([0, 90], list(range(5, FRAMES, 10)))


def test_posed_keyframes_near_each_other_need_no_library() -> None:
    posed, matched = used([*range(0, 43, 3), 90], alike())
    assert posed == [*range(0, 43, 3), 90]
    assert not set(matched) & set(range(43)) and {55, 65, 75, 85} <= set(matched)


def test_a_library_of_another_motion_is_used_outside_posed_keyframes_only() -> None:
    posed, matched = used([20, 45, 70], unlike())
    assert posed == [20, 45, 70]
    assert matched == [5, 15, 75, 85]


def test_with_one_posed_keyframe_or_none_all_are_used() -> None:
    every = list(range(5, FRAMES, 10))
    assert used([], unlike()) == ([], every)
    assert used([40], unlike()) == ([40], every)


def test_a_clip_in_which_nothing_is_seen_keeps_a_library_that_agrees() -> None:
    hidden = replace(TRACKS, quality=np.zeros_like(TRACKS.quality))
    keyframes = (
        Keyframe(0, TRUTH[0]),
        *(Keyframe(i, alike()[i], matched=SAID) for i in (30, 60)),
        Keyframe(90, TRUTH[90]),
    )
    assert select_keyframes(keyframes, MODEL, hidden, FPS) == keyframes


def test_keypoints_alone_judge_as_markers_do() -> None:
    rng = np.random.default_rng(6)
    pixel, _ = MODEL.camera.project(BODY.points(BODY.pose(TRUTH)), np.arange(FRAMES)[:, None])
    pixel = pixel + rng.normal(0.0, 1.0, pixel.shape) + np.array([2.0, -1.0])
    names = BODY.skeleton.point_names
    mirror = [names.index(mirrored_point(name)) for name in names]
    pixel[20:38] = pixel[20:38][:, mirror]
    wrong = rng.random(pixel.shape[:2]) < 0.1
    pixel[wrong] += 60.0
    seen = Keypoints(names, ("test",) * 13, pixel, np.ones(pixel.shape[:2]), np.full((FRAMES, 13, 3), np.nan))
    bare = RegionModel(BODY, MODEL.camera, ())
    unmarked = RegionTracks.unmarked(TRACKS.time_s, TRACKS.size)

    def matched(posed: list[int], library: Posture) -> list[int]:
        keyframes = [Keyframe(i, library[i], matched=SAID) for i in range(5, FRAMES, 10) if i not in posed]
        keyframes += [Keyframe(i, TRUTH[i]) for i in posed]
        ordered = tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))
        left = select_keyframes(ordered, bare, unmarked, FPS, seen)
        return [keyframe.index for keyframe in left if keyframe.matched is not None]

    assert matched([0, 90], alike()) == list(range(5, FRAMES, 10))
    assert matched([20, 45, 70], unlike()) == [5, 15, 75, 85]
    assert not set(matched([*range(0, 43, 3), 90], alike())) & set(range(43))


def test_postures_composed_for_the_footage_are_not_judged_by_those_that_were_corrected() -> None:
    said = Matched(COMPOSED, "step", False, 0.9)
    found = [Keyframe(i, unlike()[i], matched=said) for i in (5, 30, 60, 85)]
    posed = [Keyframe(i, TRUTH[i]) for i in (20, 45, 70)]
    given = tuple(sorted([*found, *posed], key=lambda key: key.index))
    assert select_keyframes(given, MODEL, TRACKS, FPS) == given
    matched = Keyframe(38, unlike()[38], matched=SAID)
    more = tuple(sorted([*given, matched], key=lambda key: key.index))
    assert select_keyframes(more, MODEL, TRACKS, FPS) == given
