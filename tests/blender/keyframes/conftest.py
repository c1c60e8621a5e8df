"""What the tests of found keyframes share: a take without keyframes, and a stand-in for what is found."""

from types import SimpleNamespace

import bpy
import pytest
from _results import made_up_frames, wave_library
from keymark.core.poses import clip as clip_posing
from keymark.core.poses.found_poses import FoundPoses
from keymark.core.progress import Progress
from keymark.core.session import pose as pose_stage
from keymark.core.take.motion import Motion
from keymark.core.take.take import Take
from keymark.operators.keyframes import posing
from keymark.operators.library import registry
from keymark.operators.shell import results
from keymark.operators.shell.takes import active_take

Group = bpy.types.PropertyGroup


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch, wave_motion: Motion) -> SimpleNamespace:
    """What Pose All finds in this test, and a record of its arguments; the job takes three steps."""
    asked = SimpleNamespace(takes=[], floors=[], frames=[], between=[], libraries=[])
    asked.confidences, asked.contradictions = {0: 0.9, 6: 0.3, 12: 0.7}, {}
    asked.error, asked.meanwhile = None, lambda: None

    def pose_clip(seen, libraries, floor_m, _count=None, between=None, frames=None, floor_open=False):
        frames = tuple(asked.confidences) if frames is None else frames
        asked.takes.append(seen.take)
        asked.floors.append(floor_m)
        asked.frames.append(tuple(frames))
        asked.between.append(between)
        asked.libraries.append([library.identifier for library in libraries])
        for step in range(3):
            yield Progress("Composing postures", step / 3)
        asked.meanwhile()
        if asked.error:
            raise asked.error
        confidences = {index: asked.confidences.get(index, 0.8) for index in frames}
        found = made_up_frames(wave_motion, confidences)
        return FoundPoses(found, wave_motion.posture, 0.75, 0.02, "it is", asked.contradictions)

    for module in (clip_posing, pose_stage):
        monkeypatch.setattr(module, "pose_clip", pose_clip)
    libraries = [wave_library(wave_motion), wave_library(wave_motion, "walking")]
    monkeypatch.setattr(registry, "all_libraries", lambda: libraries)
    return asked


@pytest.fixture
def unposed(registered: None, tiny_take: Take) -> Group:
    """The tiny take opened, without its keyframes; frames 1, 7 and 13 are proposed."""
    results.clear_cache()
    (tiny_take.folder / "keyframes.json").unlink()
    bpy.ops.keymark.open_take(filepath=str(tiny_take.folder / "take.json"))
    take = active_take(bpy.context.scene)
    for frame in (1, 7, 13):
        take.proposals.add().frame = frame
    return take


@pytest.fixture
def found(unposed: Group, given: SimpleNamespace) -> Group:
    """That take with found keyframes at those frames, the middle one doubtful, which is shown."""
    assert bpy.ops.keymark.pose_all() == {"FINISHED"}
    return active_take(bpy.context.scene)


@pytest.fixture
def still_neighbors(monkeypatch: pytest.MonkeyPatch) -> None:
    """Found keyframes around a corrected one stay as they are."""
    monkeypatch.setattr(posing, "_pose_anew", lambda *_: 0)
