"""Sentences on clips of which several could be true: those that exclude each other never stand together."""

from pathlib import Path

import pytest
from keymark.core.api import animate
from keymark.core.detect.pose_network import MODEL
from keymark.core.estimate.reconstruct import Reconstruction
from keymark.core.progress import run
from keymark.core.session.pose import Posed

CLIPS = {
    "turn4_cut_to_another_camera/hardcut2.mp4": ("cut at frame 46",),
    "turn4_side_by_side_mirror/mirrored_twin.mp4": ("mirrored copies of each other",),
    "turn4_wide_pixels/anamorphic.mp4": ("1.33 times as wide as high",),
}
"""In ../shared/failing, and what alone is to be said of each beside what its poses rest on."""


@pytest.mark.slow
@pytest.mark.parametrize("name", CLIPS)
def test_of_a_clip_the_one_true_reason_is_said(repository: Path, name: str) -> None:
    clip = repository.parent / "shared" / "failing" / name
    if not (clip.is_file() and MODEL.is_file()):
        pytest.skip("no shared/failing, or no pose network")
    session = run(animate(clip, 1.76))
    first, *others = sorted(session[Reconstruction].notes, key=lambda note: "no keyframe was" not in note)
    assert "no keyframe was posed" in first
    assert len(others) == len(CLIPS[name])
    assert all(said in note for said, note in zip(CLIPS[name], others, strict=True))
    found = session[Posed].found
    assert found is not None and "nobody is seen" not in found.reason and "on its side" not in found.reason
