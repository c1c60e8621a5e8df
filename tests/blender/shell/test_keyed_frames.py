"""Frames that are keyed, asked for one by one and at once."""

import numpy as np
import pytest
from keymark.operators.shell.keyed_frames import has_frame, have_frames


@pytest.mark.parametrize("known", [(), (3.0,), (1.0, 4.25, 9.0)])
def test_many_frames_are_told_like_one(known: tuple[float, ...]) -> None:
    wanted = np.arange(0.0, 12.0, 0.25)
    assert have_frames(known, wanted).tolist() == [has_frame(known, frame) for frame in wanted]
    assert have_frames(known, []).tolist() == []
