"""The markers' regions in a single frame."""

import numpy as np
import pytest
from _drawn_clip import STYLES, clip_of, draw, finish, moving
from keymark.core.errors import InputError
from keymark.core.footage.markers import regions_of_frame, track_markers


def test_one_frame_is_measured_as_in_a_pass_over_the_clip() -> None:
    rng = np.random.default_rng(1)
    clip = clip_of([draw(moving(index), rng) for index in range(30)])
    whole = finish(track_markers(clip, STYLES))
    for index in (0, 13, 29):
        one = regions_of_frame(clip, index / 30.0, STYLES)
        assert one.names == whole.names
        assert one.frame_count == 1
        assert np.abs(one.centroid[0] - whole.centroid[index]).max() < 0.1
        np.testing.assert_allclose(one.area[0], whole.area[index], rtol=0.02)


def test_a_frame_beyond_the_end_is_refused() -> None:
    rng = np.random.default_rng(2)
    clip = clip_of([draw(moving(index), rng) for index in range(12)])
    with pytest.raises(InputError, match="no frame at 0.50 s"):
        regions_of_frame(clip, 0.5, STYLES)
