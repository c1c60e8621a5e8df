"""Takes with matched keyframes: their notes, and how matched keyframes move beside posed ones."""

from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from _synthetic_take import true_postures, write_synthetic_take
from keymark.core.api import reconstruct
from keymark.core.body.human import ANKLES
from keymark.core.estimate.notes import filter_notes, found_notes
from keymark.core.estimate.reconstruct import reconstruct as estimated
from keymark.core.estimate.sigma import place_depth_std_m
from keymark.core.poses.found_poses import NEAR_FRAMES, Candidate, FoundPoses, MatchedFrame, with_found
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.progress import run
from keymark.core.session.stages import seen_in
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 24
TRUTH = true_postures(FRAMES)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(cast(Path, tmp_path_factory.mktemp("takes")) / "wave", FRAMES))


def said(confidence: float = 0.9) -> Matched:
    return Matched("waving", "wave", False, confidence)


def unposed(take: Take, confidence: float = 0.9) -> Take:
    """The same take as if its keyframes had been matched, the second of them less surely."""
    sure = [confidence if row == 1 else 0.95 for row in range(len(take.keyframes))]
    keyframes = [replace(k, matched=said(c)) for k, c in zip(take.keyframes, sure, strict=True)]
    return replace(take, keyframes=tuple(keyframes))


def found(frames: list[int], library: str = "waving") -> FoundPoses:
    known = tuple(MatchedFrame(i, (Candidate(TRUTH[i], "wave", False, 0.8),)) for i in frames)
    return FoundPoses(known, TRUTH, 0.9, 0.0, "it is", library=library)


def test_the_notes_say_that_all_keyframes_are_matched(take: Take) -> None:
    sure, unsure = found_notes(unposed(take)), found_notes(unposed(take, 0.2))
    assert len(sure) == 1 and "no keyframe was posed" in sure[0] and "composed of all libraries" in sure[0]
    assert len(unsure) == 2
    assert f"pose frame {take.keyframes[1].index + take.frame_start} " in unsure[1]


def test_posed_keyframes_alone_need_no_note_and_both_kinds_are_counted(take: Take) -> None:
    assert found_notes(take) == ()
    first, *others = take.keyframes
    both = replace(take, keyframes=(first, *(replace(one, matched=said()) for one in others)))
    assert found_notes(both)[0].startswith(f"1 of {len(take.keyframes)} keyframes is posed")


def test_the_notes_name_the_limits_of_the_filter(take: Take) -> None:
    assert filter_notes(take) == ()
    assert "ekf" in filter_notes(unposed(take))[0]


def test_a_reconstruction_has_these_notes_and_a_larger_depth_variance(take: Take) -> None:
    posed = run(reconstruct(take))
    matched = run(reconstruct(unposed(take), reading=posed.reading))
    assert any("no keyframe was posed" in note for note in matched.notes)
    assert not any("posed:" in note for note in posed.notes)
    assert (matched.motion.sigma_m > posed.motion.sigma_m).all()


def test_where_the_camera_was_found_the_distance_from_it_is_no_error(take: Take) -> None:
    seen = seen_in(unposed(take), run(reconstruct(take)).reading)
    placed, found_camera = (run(estimated(seen, placed=each)).motion for each in (True, False))
    assert np.array_equal(placed.points, found_camera.points)
    added = np.sqrt(placed.sigma_m**2 - found_camera.sigma_m**2)
    lower = placed.points[:, ANKLES, 2].min(axis=1)
    expected = place_depth_std_m(placed.points, lower, take.camera)
    np.testing.assert_allclose(added, np.broadcast_to(expected[:, None], added.shape), rtol=1e-6)


def test_matched_keyframes_move_beside_posed_ones(take: Take) -> None:
    posed = replace(take, keyframes=(Keyframe(0, TRUTH[0]), Keyframe(12, TRUTH[12])))
    keyframes = with_found(posed, found([0, 6, 11, 23])).keyframes
    mixed = {keyframe.index: keyframe for keyframe in keyframes}
    assert sorted(mixed) == [0, NEAR_FRAMES + 1, 6, 12 - NEAR_FRAMES - 1, 12, 23]
    assert mixed[0].matched is None and mixed[12].matched is None
    beside = mixed[NEAR_FRAMES + 1]
    assert beside.matched is not None
    np.testing.assert_array_equal(beside.posture.angles, TRUTH[NEAR_FRAMES + 1].angles)
