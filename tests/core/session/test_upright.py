"""Clips as they come from elsewhere: on their side, and with the performer beside a mirrored copy."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from keymark.core.detect.pose_network import MODEL
from keymark.core.progress import run
from keymark.core.session.described import described
from keymark.core.session.see import PictureTurnedError, require_upright
from keymark.core.session.session import Session, Sight
from keymark.core.session.stages import reach
from keymark.core.take.description import describe
from keymark.core.take.performer_keypoints import people_of, performer_keypoints

pytestmark = pytest.mark.slow


def sighted(repository: Path, name: str) -> Session:
    """A session of a clip beside the project in which everybody is detected."""
    clip = repository.parent / "shared" / "failing" / name
    if not (clip.exists() and MODEL.exists()):
        pytest.skip("no shared/failing, or no pose network")
    description = describe(clip, {"actor": {"height_m": 1.76}, "keyframes": "auto"}, "a test")
    return run(reach(Session(described(description, description.settings)), "see"))


def test_a_picture_on_its_side_is_noticed(repository: Path) -> None:
    session = sighted(repository, "turn4_lying_video_without_a_flag/sideways.mp4")
    with pytest.raises(PictureTurnedError) as noticed:
        require_upright("see", session)
    assert noticed.value.turn_deg == 270
    require_upright("place", session)
    require_upright("see", replace(session, inputs=replace(session.inputs, detects=False)))


def test_a_mirrored_copy_is_said_and_either_is_taken(repository: Path) -> None:
    session = sighted(repository, "turn4_side_by_side_mirror/mirrored_twin.mp4")
    require_upright("see", session)
    (people,), take = session[Sight].checked, session.inputs.take
    (note,) = performer_keypoints(replace(take, keypoints=(people,))).notes
    assert "mirrored copies of each other, of whom the one on the" in note
    middle = [
        float(np.nanmedian([np.nanmean(frame.pixel[..., 0]) for frame in own.frames if len(frame.pixel)]))
        for own in (people_of(people, number, take.fps) for number in (1, 2))
    ]
    assert middle[0] < people.size[0] / 2 < middle[1]
