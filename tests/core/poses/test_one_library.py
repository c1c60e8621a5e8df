"""One library alone, with tracks or keypoints of a performer of other proportions who moves another way."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np
import pytest
from _performed import (
    BODY,
    FRAMES,
    NAMES,
    camera,
    detected,
    errors_m,
    exchanged,
    filmed,
    performed,
    unmarked,
)
from _recorded import assert_recorded
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import SeenPeople
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading
from keymark.core.poses.clip import pose_clip
from keymark.core.poses.found_poses import with_found
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.library import Library
from keymark.core.progress import run
from keymark.core.session.stages import seen_in
from keymark.core.take.take import Take

pytestmark = pytest.mark.slow
NOBODY = SeenPeople.nobody(len(NAMES))


@pytest.mark.parametrize("heading_deg", [-100.0, 35.0])
def test_walking_is_found_in_its_phase_heading_and_place(walking: Library, heading_deg: float) -> None:
    truth = performed(walking, np.radians(heading_deg))
    found = run(pose_clip(seen_in(*filmed(truth, camera())), [walking], floor_m=0.0))
    rooted, absolute = errors_m(found, truth)
    assert rooted < 0.06
    assert absolute < 0.15
    assert found.fit > 0.8
    assert [frame.index for frame in found.frames][0::4] == [0, FRAMES - 1]
    assert_recorded(f"found {heading_deg}", BODY.points(BODY.pose(found.postures)), share=1e-2)
    sure = [one.confidence for frame in found.frames for one in frame.candidates]
    assert_recorded(f"found {heading_deg}, confidence", sure, share=1e-2)
    names = {posture.name for posture in walking.postures}
    assert {one.name for frame in found.frames for one in frame.candidates} <= names


Scene = tuple[Posture, tuple[Take, Reading]]


def on_the_spot(walking: Library) -> Scene:
    there = performed(walking, np.radians(35.0))
    level = np.append(there.translation[:, :2].mean(axis=0), 0.0)
    hips = level + there.translation * np.array([0.0, 0.0, 1.0])
    truth = Posture(there.skeleton, hips, there.rotations, there.angles)
    return truth, filmed(truth, camera())


def moving_camera_and_hidden_markers(walking: Library) -> Scene:
    truth = performed(walking, np.radians(60.0))
    return truth, filmed(truth, camera(FRAMES), hidden=0.1)


def keypoints(walking: Library, heading_deg: float = 35.0, hinted: bool = True, wrong: float = 0.0) -> Scene:
    truth = performed(walking, np.radians(heading_deg))
    people = detected(truth, camera(), wrong=wrong)
    people = exchanged(people, range(10, 35)) if wrong else people
    return truth, unmarked(truth, camera(), people if hinted else people.without_hints())


def exchanged_throughout_beside_markers(walking: Library) -> Scene:
    truth = performed(walking, np.radians(35.0))
    take, reading = filmed(truth, camera())
    return truth, (replace(take, keypoints=(exchanged(detected(truth, camera()), range(FRAMES)),)), reading)


@pytest.mark.parametrize(
    ("scene", "rooted_m", "absolute_m"),
    [
        (on_the_spot, 0.07, 0.15),
        (moving_camera_and_hidden_markers, 0.07, 0.3),
        *((partial(keypoints, heading_deg=h, hinted=i), 0.075, 0.2) for h in (-100.0, 35.0) for i in (0, 1)),
        (partial(keypoints, wrong=0.2), 0.075, 0.3),
        (exchanged_throughout_beside_markers, 0.075, 0.3),
    ],
)
def test_walking_is_found(
    walking: Library, scene: Callable[[Library], Scene], rooted_m: float, absolute_m: float
) -> None:
    truth, (take, reading) = scene(walking)
    found = run(pose_clip(seen_in(take, reading), [walking], floor_m=0.0))
    rooted, absolute = errors_m(found, truth)
    assert rooted < rooted_m and absolute < absolute_m
    assert found.fit > 0.5


def test_an_unknown_floor_is_found_by_the_sizes(walking: Library) -> None:
    truth = performed(walking, np.radians(35.0), floor_m=-1.0)
    found = run(pose_clip(seen_in(*filmed(truth, camera())), [walking]))
    assert found.floor_m == pytest.approx(-1.0, abs=0.3)
    assert errors_m(found, truth)[0] < 0.07


def test_a_mirrored_performance_is_found(squatting: Library) -> None:
    sided = next(motion for motion in squatting.motions if "kneel" in motion.name)
    library = replace(
        squatting,
        motions=(sided,),
        postures=tuple(
            posture
            for posture in squatting.postures
            if posture.name in {step.posture for step in sided.steps}
        ),
    )
    truth = mirrored(performed(library, 0.3, style_rad=0.03))
    found = run(pose_clip(seen_in(*filmed(truth, camera())), [library], floor_m=0.0))
    assert errors_m(found, truth)[0] < 0.07


def test_confidence_follows_what_is_right(walking: Library, squatting: Library) -> None:
    rng = np.random.default_rng(11)
    led, walk = performed(squatting, 0.0), performed(walking, 0.6)
    knots = rng.normal(0.0, 0.9, (6, led.skeleton.dof_count))
    knots[:, :6] *= 0.3
    moves = np.stack(
        [np.interp(np.arange(FRAMES), np.linspace(0, FRAMES, 6), dof) for dof in knots.T], axis=1
    )
    sure, off, doubtful = [], [], []
    for truth, library in ((walk, walking), (walk, squatting), (led.plus(moves), squatting)):
        take, reading = filmed(truth, camera())
        found = run(pose_clip(seen_in(take, reading), [library]))
        kept = [keyframe.matched for keyframe in with_found(take, found).keyframes]
        assert len(kept) == len(found.frames) and found.library == library.identifier
        doubtful.append([said is not None and said.is_doubtful for said in kept])
        sure.append(float(np.mean([frame.candidates[0].confidence for frame in found.frames])))
        off.append(errors_m(found, truth)[0])
        for frame in found.frames:
            assert 1 <= len(frame.candidates) <= 6
            assert all(0.0 <= one.confidence <= 1.0 for one in frame.candidates)
    assert off[0] < 0.06 and off[1] < 0.1 and off[2] > 0.2
    assert sure[0] > sure[1] > sure[2] + 0.3
    assert not any(doubtful[0]) and sum(doubtful[2]) >= len(doubtful[2]) - 1


def test_posed_keyframes_steer_the_match(walking: Library) -> None:
    truth = performed(walking, np.radians(35.0), style_rad=0.15, floor_m=0.2)
    take, reading = filmed(truth, camera())
    ends = tuple(Keyframe(index, truth[index]) for index in (0, FRAMES - 1))
    alone = run(pose_clip(seen_in(take, reading), [walking]))
    steered = run(pose_clip(seen_in(replace(take, keyframes=ends), reading), [walking]))
    assert alone.floor_m == 0.0  # where sizes allow it; not where the camera's own height is open
    anywhere = run(pose_clip(seen_in(take, reading), [walking], floor_open=True))
    assert anywhere.floor_m == pytest.approx(0.2, abs=0.1)
    assert steered.floor_m == pytest.approx(0.2, abs=0.05)
    assert errors_m(steered, truth)[1] < 0.8 * errors_m(alone, truth)[1]
    for end in ends:
        off = steered.postures.translation[end.index] - end.posture.translation
        assert np.linalg.norm(off) < 0.05


def test_posed_keyframes_stay_beside_matched_ones(walking: Library) -> None:
    take, reading = filmed(performed(walking, 0.6), camera())
    match = run(pose_clip(seen_in(take, reading), [walking]))
    first = match.frames[0]
    posed = Keyframe(first.index + 1, first.candidates[0].posture)
    mixed = with_found(replace(take, keyframes=(posed,)), match)
    assert [one.index for one in mixed.keyframes] == [posed.index, *(f.index for f in match.frames[1:])]
    assert mixed.keyframes[0].matched is None
    said = mixed.keyframes[1].matched
    assert said is not None
    assert (said.library, said.posture) == ("composed", match.frames[1].candidates[0].name)
    assert with_found(mixed, match).keyframe_indices == mixed.keyframe_indices


def test_keypoints_find_the_arms_that_few_markers_leave_open(walking: Library) -> None:
    truth = performed(walking, np.radians(60.0))
    take, reading = filmed(truth, camera())
    names = ("centroid", "second_moment", "area", "quality", "clipped")
    trunk = {name: getattr(reading.tracks, name)[:, :1] for name in names}
    bare = replace(take, markers=take.markers[:1])
    seen = Reading(replace(reading.tracks, names=reading.tracks.names[:1], **trunk))
    alone = errors_m(run(pose_clip(seen_in(bare, seen), [walking], floor_m=0.0)), truth)[0]
    both = replace(bare, keypoints=(detected(truth, camera()),))
    assert errors_m(run(pose_clip(seen_in(both, seen), [walking], floor_m=0.0)), truth)[0] < 0.7 * alone


def test_keypoints_that_are_never_seen_change_nothing(walking: Library) -> None:
    truth = performed(walking, 0.6)
    take, reading = filmed(truth, camera())
    blind = replace(detected(truth, camera()), frames=(NOBODY,) * FRAMES)
    first, second = (
        run(pose_clip(seen_in(each, reading), [walking]))
        for each in (take, replace(take, keypoints=(blind,)))
    )
    np.testing.assert_array_equal(first.postures.to_vector(), second.postures.to_vector())


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"markers": (), "keypoints": ()}, "neither markers nor keypoints"),
        ({"markers": ()}, "no keypoint is seen"),
        ({"keypoints": ()}, "no marker is seen"),
    ],
)
def test_what_shows_nobody_is_refused(walking: Library, change: dict[str, Any], words: str) -> None:
    truth = performed(walking, 0.6)
    take, reading = filmed(truth, camera())
    take = replace(take, keypoints=(replace(detected(truth, camera()), frames=(NOBODY,) * FRAMES),))
    nothing = replace(reading.tracks, centroid=np.full_like(reading.tracks.centroid, np.nan))
    with pytest.raises(InputError, match=words):
        run(pose_clip(seen_in(replace(take, **change), Reading(nothing)), [walking]))


def test_libraries_without_a_posture_are_refused(walking: Library) -> None:
    seen = seen_in(*filmed(performed(walking, 0.6), camera()))
    with pytest.raises(InputError, match="no keyframe library with a posture is given; at least one"):
        run(pose_clip(seen, [replace(walking, postures=(), motions=())]))
