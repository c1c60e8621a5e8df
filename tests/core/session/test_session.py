"""The list of stages: what is kept of them, a camera that moves, and a clip animated from Python."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from _drawn_clip import KnownPeople
from _synthetic_take import BODY, SIZE, gliding, true_postures, write_shaken, write_synthetic_take
from keymark.core import api
from keymark.core.api import run
from keymark.core.body.human import HUMAN
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import People, SeenPeople
from keymark.core.estimate.reconstruct import Reconstruction
from keymark.core.markers.reading import Reading
from keymark.core.prior.learning import LibraryMetadata, learn_library
from keymark.core.progress import Progress
from keymark.core.session import see
from keymark.core.session.session import Inputs, Placed, Session, Sight, Stage, advance
from keymark.core.session.stages import STAGES, reach
from keymark.core.take.motion import read_motion
from keymark.core.take.take_file import read_take


@pytest.fixture(scope="module")
def inputs(tmp_path_factory: pytest.TempPathFactory) -> Inputs:
    take = read_take(write_synthetic_take(tmp_path_factory.mktemp("session") / "take", 16))
    return Inputs(take, "interpolation")


def stages_made(inputs: Inputs, kept: dict[str, object]) -> list[str]:
    """The stages whose results are not among those kept."""
    before = set(map(id, kept.values()))
    session = run(reach(Session(inputs), "reconstruct", kept))
    return [name for name, result in session.made.items() if id(result) not in before]


def test_a_stage_is_made_again_where_anything_that_it_depends_on_has_changed(inputs: Inputs) -> None:
    kept: dict[str, object] = {}
    names = [stage.name for stage in STAGES]
    assert names == ["read", "see", "place", "pose", "reconstruct", "finish", "retarget"]
    assert stages_made(inputs, kept) == names[:5]
    assert stages_made(inputs, kept) == []
    assert stages_made(replace(inputs, method="ekf"), kept) == ["reconstruct"]
    unmarked = replace(inputs, take=replace(inputs.take, markers=()))
    stages_made(unmarked, kept)
    first, *others = unmarked.take.keyframes
    first = replace(first, posture=first.posture.lowered(0.1))
    moved = replace(unmarked, take=replace(unmarked.take, keyframes=(first, *others)))
    assert stages_made(moved, kept) == ["place", "pose", "reconstruct"]


@pytest.mark.parametrize("is_kept", [False, True])
def test_the_network_looks_while_the_clip_is_read_or_by_itself_where_that_is_known(
    inputs: Inputs, monkeypatch: pytest.MonkeyPatch, is_kept: bool
) -> None:
    known = run(reach(Session(inputs), "see"))
    nobody = SeenPeople.nobody(13)
    people = People(HUMAN.point_names, "drawn", SIZE, (nobody,) * 16)
    finder, found = KnownPeople(people), [Progress("Detecting keypoints", 1.0)]

    def find(*_given: object) -> Any:
        yield found.pop()
        return people

    monkeypatch.setattr(see, "PoseNetwork", SimpleNamespace)
    monkeypatch.setattr(see, "_network", lambda: None)  # which is kept for other tests
    monkeypatch.setattr(see, "PeopleFinder", lambda *_given: finder)
    monkeypatch.setattr(see, "find_people", find)
    asked = replace(inputs, detects=True, kept=known[Reading] if is_kept else None)
    assert run(reach(Session(asked), "see"))[Sight].people == (people,)
    assert (finder.count, len(found)) == ((0, 0) if is_kept else (16, 1))
    work = {stage.name: stage.work(asked) for stage in STAGES[:2]}
    assert work["see" if is_kept else "read"] > 1.6 > 1.0 > work["read" if is_kept else "see"]


def test_stages_of_blender_are_done_by_its_bridge_and_told_as_they_are_complete(inputs: Inputs) -> None:
    def finish(session: Session) -> Any:
        yield from ()
        return session[Reconstruction].motion.method

    told: list[str] = []
    bridged = replace(inputs, bridge={"finish": finish})
    session = run(reach(Session(bridged), "retarget", keep=lambda stage, _session: told.append(stage)))
    assert told == list(session.made) == [stage.name for stage in STAGES]
    assert session.made["finish"] == "interpolation" and session.made["retarget"] is None


def test_a_further_stage_is_a_line_in_the_list(inputs: Inputs) -> None:
    def loop(session: Session) -> Any:
        yield from ()
        return session[Reconstruction].motion.posture[::-1]

    stages = (*STAGES, Stage("loop", loop, lambda _inputs: (), lambda _inputs: 0.1))
    session = run(advance(Session(inputs), stages))
    first, last = session[Posture][0], session[Reconstruction].motion.posture[-1]
    np.testing.assert_array_equal(first.minus(last), 0.0)


def test_a_clip_is_animated_by_the_lines_of_the_docs_and_alike_where_hands_shake_the_camera(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, repository: Path
) -> None:
    said = LibraryMetadata("Swaying", "Nobody")
    library = learn_library(BODY, true_postures(24), np.arange(24) / 30.0, said)
    monkeypatch.setattr(api, "find_libraries", lambda *_: (library,))
    monkeypatch.chdir(tmp_path)
    lines = (
        (repository / "docs" / "api.md").read_text(encoding="utf-8").split("```")[1].removeprefix("python")
    )
    points = []
    for turn_rad in (0.0, 0.02):
        write_shaken(tmp_path / "kick.mp4", gliding(), turn_rad)
        names: dict[str, Any] = {}
        exec(lines, names)
        assert (names["session"][Placed].seen.reading.steady is not None) == (turn_rad > 0.0)
        points.append(read_motion(tmp_path / "kick.json").points)
    still, shaken = (each - each[:, [7, 8]].mean(axis=1, keepdims=True) for each in points)
    assert np.linalg.norm(still - shaken, axis=-1).mean() < 0.03
