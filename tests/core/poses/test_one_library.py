"""One library alone, with tracks of a performer of other proportions and another way of moving."""

from dataclasses import replace

import numpy as np
import pytest
from _performed import BODY, FRAMES, camera, errors_m, filmed, performed
from _recorded import assert_recorded
from keymark.core.body.mirror import mirrored
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading
from keymark.core.poses.clip import pose_clip
from keymark.core.poses.found_poses import with_found
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.library import Library
from keymark.core.progress import run
from keymark.core.session.stages import seen_in

pytestmark = pytest.mark.slow


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


def test_walking_on_the_spot_is_walking(walking: Library) -> None:
    there = performed(walking, np.radians(35.0))
    level = np.append(there.translation[:, :2].mean(axis=0), 0.0)
    hips = level + there.translation * np.array([0.0, 0.0, 1.0])
    truth = Posture(there.skeleton, hips, there.rotations, there.angles)
    rooted, absolute = errors_m(
        run(pose_clip(seen_in(*filmed(truth, camera())), [walking], floor_m=0.0)), truth
    )
    assert rooted < 0.07
    assert absolute < 0.15


def test_a_camera_that_moves_and_markers_that_hide_do_no_harm(walking: Library) -> None:
    truth = performed(walking, np.radians(60.0))
    found = run(pose_clip(seen_in(*filmed(truth, camera(FRAMES), hidden=0.1)), [walking]))
    assert errors_m(found, truth)[0] < 0.07


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
    assert alone.floor_m == 0.0
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


def test_what_cannot_be_matched_is_refused(walking: Library) -> None:
    take, reading = filmed(performed(walking, 0.6), camera())
    with pytest.raises(InputError, match="no keyframe library with a posture is given"):
        run(pose_clip(seen_in(take, reading), [replace(walking, postures=(), motions=())]))
    nothing = replace(reading.tracks, centroid=np.full_like(reading.tracks.centroid, np.nan))
    with pytest.raises(InputError, match="no marker is seen"):
        run(pose_clip(seen_in(take, Reading(nothing)), [walking]))
