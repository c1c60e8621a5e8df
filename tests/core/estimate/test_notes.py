"""Notes on a result: they name what a take has, and nothing that it has not."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from _synthetic_take import write_synthetic_take
from keymark.core.estimate.notes import evidence_notes
from keymark.core.footage.keypoints.keypoints import People
from keymark.core.take.take import with_evidence
from keymark.core.take.take_file import read_take


@pytest.mark.parametrize(
    ("kinds", "checked"),
    [
        (("markers",), "the actor's lengths and the markers' segments"),
        (("keypoints",), "the actor's lengths and whom the keypoints show"),
        (("markers", "keypoints"), "lengths, the markers' segments and whom the keypoints show"),
        (("contours",), "the actor's lengths and the poses"),
    ],
)
def test_doubtful_keyframes_send_people_to_what_the_take_has(
    kinds: tuple[str, ...], checked: str, tmp_path: Path
) -> None:
    take = read_take(write_synthetic_take(tmp_path / "take", 8, 4))
    people = People(("nose",), "a detector", take.camera.resolution, ())
    take = with_evidence(replace(take, keypoints=(people,)), kinds)
    evidence = SimpleNamespace(
        model=SimpleNamespace(camera=take.camera),
        timing_frames=0.0,
        posing_scale=9.0,
        distrust=[1.0] * len(take.markers),
    )
    (note,) = evidence_notes(take, evidence)
    assert note.endswith(checked)
