"""What posed keyframes say of matched ones between and beside them."""

import numpy as np
from _scene import exercise
from keymark.core.body.posture import Posture
from keymark.core.prior.keyframes import Keyframe, Matched, with_offset
from keymark.core.prior.texts import COMPOSED

FPS = 30.0
TRUTH = exercise(91)
SAID = Matched("walking", "step", False, 0.9)
STYLE = np.where(np.arange(TRUTH.skeleton.dof_count) < 3, 0.05, 0.15)


def matched(frames: list[int], library: Posture) -> list[Keyframe]:
    """Keyframes as a library would have them."""
    return [Keyframe(frame, library[frame], matched=SAID) for frame in frames]


def error(keyframes: tuple[Keyframe, ...]) -> float:
    """Mean distance of the matched ones from the truth, in the posture's unknowns."""
    off = [np.abs(k.posture.minus(TRUTH[k.index])).mean() for k in keyframes if k.matched is not None]
    return float(np.mean(off))


def in_order(*keyframes: Keyframe) -> tuple[Keyframe, ...]:
    return tuple(sorted(keyframes, key=lambda keyframe: keyframe.index))


def test_a_difference_that_lasts_is_taken_out_of_all_matched_keyframes() -> None:
    """Two posed keyframes remove most of the performer's offset, and more of it than one does."""
    library = TRUTH.plus(np.tile(STYLE, (91, 1)))
    every = matched(list(range(3, 90, 6)), library)
    before = in_order(*every)
    one, doubt_one = with_offset(in_order(*every, Keyframe(30, TRUTH[30])), FPS)
    two, doubt_two = with_offset(in_order(*every, Keyframe(20, TRUTH[20]), Keyframe(70, TRUTH[70])), FPS)
    assert error(two) < 0.5 * error(before)
    assert error(two) < error(one) < 0.7 * error(before)
    assert doubt_two[doubt_two > 0.0].mean() < doubt_one[doubt_one > 0.0].mean() < 1.0


def test_posed_keyframes_stay_and_are_not_doubted() -> None:
    given = in_order(*matched([0, 30, 60, 90], TRUTH.plus(np.tile(STYLE, (91, 1)))), Keyframe(45, TRUTH[45]))
    changed, doubt = with_offset(given, FPS)
    assert changed[2] is given[2] and doubt[2] == 0.0
    assert [keyframe.index for keyframe in changed] == [0, 30, 45, 60, 90]
    assert all(keyframe.matched == SAID for keyframe in changed if keyframe.index != 45)


def test_without_posed_or_without_matched_ones_nothing_changes() -> None:
    unposed = in_order(*matched([0, 40, 80], TRUTH))
    posed = in_order(Keyframe(0, TRUTH[0]), Keyframe(80, TRUTH[80]))
    assert with_offset(unposed, FPS)[0] is unposed and with_offset(unposed, FPS)[1].tolist() == [1.0] * 3
    assert with_offset(posed, FPS)[0] is posed and with_offset(posed, FPS)[1].tolist() == [0.0] * 2


def test_a_posed_keyframe_far_from_all_matched_ones_says_little() -> None:
    """The library's posture there is unknown, so the difference does not count as the performer's offset."""
    near = with_offset(in_order(*matched([0, 10], TRUTH), Keyframe(12, TRUTH[60])), FPS)[0]
    far = with_offset(in_order(*matched([0, 10], TRUTH), Keyframe(60, TRUTH[60])), FPS)[0]
    moved = [np.abs(one[1].posture.minus(TRUTH[10])).mean() for one in (near, far)]
    assert moved[1] < 0.1 * moved[0]


def test_the_nearer_of_two_posed_keyframes_counts_more() -> None:
    drift = STYLE * np.linspace(0.0, 1.0, 91)[:, None]
    library = TRUTH.plus(drift)
    given = in_order(*matched(list(range(3, 90, 6)), library), Keyframe(2, TRUTH[2]), Keyframe(88, TRUTH[88]))
    changed, _ = with_offset(given, FPS)
    steps = [-k.posture.minus(library[k.index])[0] for k in changed if k.matched is not None]
    assert 0.0 < steps[0] < steps[-1] < 1.05 * drift[88, 0]


def test_postures_composed_for_the_footage_stay_and_are_doubted_less_near_posed_ones() -> None:
    """What a person corrects in one of them is no difference between performers."""
    said = Matched(COMPOSED, "step", False, 0.9)
    library = TRUTH.plus(np.tile(STYLE, (91, 1)))
    found = [Keyframe(frame, library[frame], matched=said) for frame in (0, 30, 60, 90)]
    changed, doubt = with_offset(in_order(*found, Keyframe(35, TRUTH[35])), FPS)
    assert all(np.abs(new.posture.minus(library[new.index])).max() < 1e-9 for new in changed if new.matched)
    assert doubt[1] < doubt[0] < 1.0 and doubt[1] < doubt[3] and doubt[2] == 0.0
    both = in_order(*found, *matched([15, 75], library), Keyframe(35, TRUTH[35]))
    moved = [np.abs(new.posture.minus(library[new.index])).max() > 0.05 for new in with_offset(both, FPS)[0]]
    assert moved == [False, True, False, True, False, True, False]
