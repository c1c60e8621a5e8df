"""Takes whose keyframes were matched: what is said of them, and where they go beside posed ones."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from _synthetic_take import true_postures, write_synthetic_take
from keymark.core.estimate.notes import filter_notes, left_out_notes, match_notes
from keymark.core.estimate.reconstruct import reconstruct
from keymark.core.matching.candidates import Candidate, MatchedFrame
from keymark.core.matching.library_match import LibraryMatch
from keymark.core.matching.match_take import NEAR_FRAMES, with_matches
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.progress import run
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 24
TRUTH = true_postures(FRAMES)


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """A small take with exact keyframes."""
    return read_take(write_synthetic_take(cast(Path, tmp_path_factory.mktemp("takes")) / "wave", FRAMES))


def said(confidence: float = 0.9) -> Matched:
    """What a keyframe says of its match."""
    return Matched("waving", "wave", False, confidence)


def unposed(take: Take, confidence: float = 0.9) -> Take:
    """The same take as if its keyframes had been matched, the second of them less surely."""
    sure = [confidence if row == 1 else 0.95 for row in range(len(take.keyframes))]
    keyframes = [replace(k, matched=said(c)) for k, c in zip(take.keyframes, sure, strict=True)]
    return replace(take, keyframes=tuple(keyframes))


def match(frames: list[int]) -> LibraryMatch:
    """A match that says the true postures."""
    matched = tuple(MatchedFrame(i, (Candidate(TRUTH[i], "wave", False, 0.8),)) for i in frames)
    library = SimpleNamespace(identifier="waving")
    return cast(LibraryMatch, SimpleNamespace(library=library, frames=matched, postures=TRUTH))


def test_it_is_said_that_nothing_was_posed_and_what_the_motion_rests_on(take: Take) -> None:
    """The library is named, and a doubtful frame as one to pose."""
    sure, unsure = match_notes(unposed(take)), match_notes(unposed(take, 0.2))
    assert len(sure) == 1 and "no keyframe was posed" in sure[0] and "waving" in sure[0]
    assert len(unsure) == 2
    assert f"pose frame {take.keyframes[1].index + take.frame_start} " in unsure[1]


def test_of_posed_keyframes_nothing_is_said_and_of_both_kinds_how_many(take: Take) -> None:
    """Posed keyframes are the usual way."""
    assert match_notes(take) == ()
    first, *others = take.keyframes
    both = replace(take, keyframes=(first, *(replace(one, matched=said()) for one in others)))
    assert match_notes(both)[0].startswith(f"1 of {len(take.keyframes)} keyframes are posed")


def test_it_is_said_what_is_left_out_and_what_the_filter_does_not_know(take: Take) -> None:
    """Some matched keyframes or all of them; nothing where there is nothing to say."""
    every = unposed(take)
    assert left_out_notes(every, 0) == () == filter_notes(take)
    assert left_out_notes(every, len(take.keyframes))[0].startswith("the library was left out")
    assert left_out_notes(every, 1)[0].startswith(f"1 of {len(take.keyframes)} matched keyframes")
    assert "ekf" in filter_notes(every)[0]


def test_a_reconstruction_tells_it_and_doubts_depth_where_nothing_was_posed(take: Take) -> None:
    """With the same postures, matched ones are stated to be farther off; posed ones as ever."""
    posed = run(reconstruct(take))
    matched = run(reconstruct(unposed(take), reading=posed.reading))
    assert any("no keyframe was posed" in note for note in matched.notes)
    assert not any("posed:" in note for note in posed.notes)
    assert (matched.motion.sigma_m > posed.motion.sigma_m).all()


def test_matched_keyframes_move_beside_posed_ones(take: Take) -> None:
    """The posed one stays what it is; the matched one takes what the match says of its new frame."""
    posed = replace(take, keyframes=(Keyframe(0, TRUTH[0]), Keyframe(12, TRUTH[12])))
    found = {keyframe.index: keyframe for keyframe in with_matches(posed, match([0, 6, 11, 23])).keyframes}
    assert sorted(found) == [0, NEAR_FRAMES + 1, 6, 12 - NEAR_FRAMES - 1, 12, 23]
    assert found[0].matched is None and found[12].matched is None
    beside = found[NEAR_FRAMES + 1]
    assert beside.matched is not None
    np.testing.assert_array_equal(beside.posture.angles, TRUTH[NEAR_FRAMES + 1].angles)
