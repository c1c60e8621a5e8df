"""A picture on its side or upside down is told by who is followed in it, and turned in the file's header."""

from pathlib import Path

import numpy as np
import pytest
from keymark.core.detect.pose_network import MODEL, PoseNetwork
from keymark.core.detect.standing_moments import picture_turn
from keymark.core.errors import InputError
from keymark.core.video.clip import Clip
from keymark.core.video.header import TURNS, can_turn, write_turned


@pytest.fixture
def upright(repository: Path) -> Path:
    """A clip of somebody who stands."""
    return repository / "presets" / "demo" / "greeting" / "clip.mp4"


def picture(path: Path) -> np.ndarray:
    """The first picture of a clip."""
    return next(iter(Clip.open(path).frames()))[2]


def test_a_header_turns_a_clip_and_turns_add_up(upright: Path, tmp_path: Path) -> None:
    first = picture(upright)
    for turn_deg in TURNS[1:]:
        turned, back = tmp_path / f"{turn_deg}.mp4", tmp_path / f"back{turn_deg}.mp4"
        write_turned(upright, turn_deg, turned)
        np.testing.assert_array_equal(picture(turned), np.rot90(first, -turn_deg // 90))
        write_turned(turned, 360 - turn_deg, back)
        np.testing.assert_array_equal(picture(back), first)


def test_what_no_header_turns_is_refused_with_how_to_turn_it(tmp_path: Path) -> None:
    other = tmp_path / "clip.avi"
    other.write_bytes(b"RIFF")
    assert not can_turn(other)
    with pytest.raises(InputError, match="clip.avi: is no MP4 or QuickTime.*transpose=2"):
        write_turned(other, 270, tmp_path / "turned.avi")


@pytest.mark.slow
@pytest.mark.parametrize("turn_deg", [0, 90])
def test_the_turn_is_that_in_which_people_are_upright(upright: Path, tmp_path: Path, turn_deg: int) -> None:
    if not MODEL.exists():
        pytest.skip("no pose network")
    clip = tmp_path / "clip.mp4"
    if turn_deg:
        write_turned(upright, turn_deg, clip)
    assert picture_turn(Clip.open(clip if turn_deg else upright), PoseNetwork()) == -turn_deg % 360
