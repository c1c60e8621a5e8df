"""The sheet of matched keyframes: the choice of keyframes, and the posture drawn over each frame."""

from dataclasses import replace

import numpy as np
import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.footage.clips.clip import Clip
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.report.match_sheet import match_sheet, shown_keyframes
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 16


@pytest.fixture(scope="module")
def take(tmp_path_factory: pytest.TempPathFactory) -> Take:
    """A take whose keyframes, but for the first, were matched."""
    read = read_take(write_synthetic_take(tmp_path_factory.mktemp("takes") / "take", FRAMES))
    matched = Matched("waving", "Hand up, with a name far too long for one cell of a sheet", True, 0.8)
    first, *others = read.keyframes
    return replace(read, keyframes=(first, *(replace(keyframe, matched=matched) for keyframe in others)))


def test_many_keyframes_are_thinned_out_evenly(take: Take) -> None:
    """Many are thinned, with the first and the last kept; a few are all shown."""
    posture = take.keyframes[0].posture
    many = replace(take, keyframes=tuple(Keyframe(index, posture) for index in range(100)))
    shown = [keyframe.index for keyframe in shown_keyframes(many)]
    assert len(shown) == 30 and (shown[0], shown[-1]) == (0, 99) and max(np.diff(shown)) <= 4
    assert shown_keyframes(take) == take.keyframes


def test_each_match_is_drawn_over_its_frame(take: Take) -> None:
    """One cell a keyframe, and in each a figure over the footage."""
    images = dict(Clip.open(take.clip, fps=take.fps).source.at([k.index for k in take.keyframes]))
    sheet = match_sheet(take, images)
    fewer = match_sheet(take, {index: images[index] for index in sorted(images)[:1]})
    assert fewer.shape[0] < sheet.shape[0] or fewer.shape[1] < sheet.shape[1]
    far = np.zeros(take.body.skeleton.dof_count)
    far[0] = 500.0
    gone = replace(take, keyframes=tuple(replace(k, posture=k.posture.plus(far)) for k in take.keyframes))
    columns = (sheet != match_sheet(gone, images)).any(axis=(0, 2))
    cells = np.array_split(columns, len(take.keyframes))
    assert all(cell.sum() > 10 for cell in cells)


def test_the_sheet_shows_where_a_match_stands(take: Take) -> None:
    """A keyframe moved aside changes its own picture."""
    images = dict(Clip.open(take.clip, fps=take.fps).source.at([k.index for k in take.keyframes]))
    before = match_sheet(take, images)
    step = np.zeros(take.body.skeleton.dof_count)
    step[0] = 0.3
    first, second, *others = take.keyframes
    moved = replace(second, posture=second.posture.plus(step))
    after = match_sheet(replace(take, keyframes=(first, moved, *others)), images)
    assert before.shape == after.shape and (before != after).any()
