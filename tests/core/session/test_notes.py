"""Sentences on clips of which several could be true: those that exclude each other never stand together."""

import ast
import re
from itertools import permutations
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import keymark
import numpy as np
import pytest
from keymark.core.api import animate
from keymark.core.detect.pose_network import MODEL
from keymark.core.estimate.notes import CAUSES, found_notes, of_true_causes
from keymark.core.estimate.reconstruct import Reconstruction
from keymark.core.prior.keyframes import Matched
from keymark.core.progress import run
from keymark.core.session.pose import Posed
from keymark.core.take.presence import absence_notes, unseen_notes
from keymark.core.video.frame_checks import FrameFindings

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


PAIRS = [(cause, effect) for cause, effects in CAUSES.items() for effect in effects]
UNRELATED = "the legs are never seen and stay at rest; pose keyframes where that is wrong"


def sentence(pattern: str, of: str) -> str:
    """A sentence that a pattern finds, on a marker or source of a name."""
    said = re.sub(r"\(\?P<of>[^)]*\)", of, pattern).replace(r"[^;]*$", "frame 5").replace(".*", "some")
    return re.sub(r"s\?", "s", re.sub(r"\((\w[^|)]*)\|[^)]*\)", r"\1", said))


@pytest.mark.parametrize(("cause", "effect"), PAIRS)
def test_of_notes_that_exclude_each_other_the_cause_is_said(cause: str, effect: str) -> None:
    true, excluded = sentence(cause, "seen"), sentence(effect, "seen")
    assert re.search(cause, true) and re.search(effect, excluded)
    for order in permutations((true, excluded, UNRELATED)):
        assert of_true_causes(order) == tuple(note for note in order if note != excluded)
    assert of_true_causes((excluded, UNRELATED, excluded)) == (excluded, UNRELATED)
    other = sentence(effect, "another")
    if "(?P<of>" in cause and other != excluded:
        assert of_true_causes((true, other)) == (true, other)


def test_no_two_notes_exclude_each_other_both_ways() -> None:
    for cause, effect in PAIRS:
        back = {first for first, second in PAIRS if re.search(first, sentence(effect, "seen"))}
        assert not any((first, cause) in PAIRS for first in back)


def test_every_pattern_is_of_a_sentence_that_is_said() -> None:
    patterns, said = {each for pair in PAIRS for each in pair}, set[str]()
    package = Path(keymark.__file__).parent
    for file in (*package.glob("core/**/*.py"), *package.glob("operators/bridge/**/*.py")):
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            parts = node.values if isinstance(node, ast.JoinedStr) else [node]
            words = [part.value for part in parts if isinstance(part, ast.Constant)]
            said |= {"".join(word for word in words if isinstance(word, str))} - patterns
    for pattern in patterns:
        fixed = re.split(r"\(\?P<of>[^)]*\)|\([^)]*\)|\.\*|\[\^;\]\*\$|\w\?|\d", pattern)
        words = max(fixed, key=len).strip(" :")
        assert any(words in one for one in said), words


@pytest.mark.parametrize(
    ("count", "said"),
    [
        (1, ("1 of 9 frames is blank", "1 of 9 pictures repeats the one", "(frame 2)", "cut at frame 2")),
        (2, ("2 of 9 frames are", "2 of 9 pictures repeat the", "(frames 2 to 3)", "cut at frames 2 to 3")),
        (3, ("3 of 9 frames are", "3 of 9 pictures repeat the", "(frames 2 to 4)", "cut at frames 2 to 4")),
    ],
)
def test_sentences_agree_with_their_numbers(count: int, said: tuple[str, ...]) -> None:
    which = tuple(range(1, 1 + count))
    notes = FrameFindings(9, blank=which, cuts=which, repeated=which).notes(1)
    assert all(words in " ".join(notes) for words in said)
    assert FrameFindings(9).notes(1) == ()
    there = np.isin(np.arange(9), which, invert=True)
    limbs = ("leg.L", "leg.R", "arm.L")[:count]
    take = SimpleNamespace(frame_start=1, keyframes=[SimpleNamespace(index=i, matched=None) for i in which])
    absent, posed = absence_notes(cast(Any, take), there)
    assert absent.startswith(f"nobody is seen in {said[3].split('at ')[1]}")
    named = {1: "keyframe 2 is", 2: "keyframes 2, 3 are", 3: "keyframes 2, 3, 4 are"}[count]
    assert posed.startswith(f"{named} posed where")
    words = {1: "the left leg is never seen and stays", 2: "the legs are never seen and stay",
             3: "the left arm and the legs are never seen and stay"}  # fmt: skip
    assert unseen_notes(limbs)[0].startswith(words[count])
    doubtful = Matched("", "", False, 0.1)
    keys = [SimpleNamespace(index=i, matched=doubtful) for i in which]
    rests, pose = found_notes(cast(Any, SimpleNamespace(frame_start=1, keyframes=keys)))
    many = "posture" if count == 1 else "postures"
    assert f"rests on {count} {many} composed" in rests
    are = "is" if count == 1 else "are"
    assert pose.startswith(f"{count} of {count} found keyframes {are} doubtful; pose frame")
    assert pose.endswith("to set it right" if count == 1 else "to set them right")
