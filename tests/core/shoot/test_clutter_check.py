"""Checks of a shoot: clutter in the markers' colors, outliers among takes, the cost of a conversion."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from _synthetic_take import PANEL, SLEEVE, panelled_take
from keymark.core.progress import run
from keymark.core.shoot.check.evidence_check import Findings, check_footage
from keymark.core.shoot.check.take_check import TakeCheck, flag_outliers
from keymark.core.take.read_footage import open_clip, read_footage
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

PROPOSAL = re.compile(r"still areas have the color of (.*); they are left out where take.json says \{?(.*)")


@pytest.fixture
def folder(repository: Path, tmp_path: Path) -> Path:
    return panelled_take(repository / "presets" / "demo" / "aerobic", tmp_path / "take")


def warnings(take: Take) -> tuple[str, ...]:
    findings, clip = Findings(), open_clip(take)
    check_footage(take, clip, clip.frame_count, findings)
    assert not findings.problems
    return tuple(findings.warnings)


def said(take: Take) -> dict[str, object]:
    (proposal,) = (sentence for sentence in warnings(take) if "they are left out" in sentence)
    names, field = PROPOSAL.match(proposal).groups()  # type: ignore[union-attr]
    assert names == SLEEVE
    return dict(json.loads("{" + field + "}"))


def test_the_check_names_what_take_json_must_say_and_the_sleeve_is_then_followed(
    folder: Path, repository: Path
) -> None:
    ((region,),) = said(read_take(folder)).values()
    np.testing.assert_allclose(region["box"], PANEL, atol=4.0)
    file = folder / "take.json"
    fields = json.loads(file.read_text(encoding="utf-8"))
    corner = {"box": [0.0, 0.0, 5.0, 5.0]}
    file.write_text(json.dumps({**fields, "ignored_regions": [corner]}), encoding="utf-8")
    proposed = said(read_take(folder))
    assert proposed["ignored_regions"] == [corner, region]
    file.write_text(json.dumps({**fields, **proposed}), encoding="utf-8")
    after = warnings(read_take(folder))
    assert not any("still" in sentence or "something else in the picture" in sentence for sentence in after)

    plain = run(read_footage(read_take(repository / "presets" / "demo" / "aerobic"))).tracks
    left_out = run(read_footage(read_take(folder))).tracks
    row = plain.names.index(SLEEVE)
    both = plain.visible[:, row] & left_out.visible[:, row]
    assert both.sum() >= plain.visible[:, row].sum() - 2
    apart = np.linalg.norm(plain.centroid[both, row] - left_out.centroid[both, row], axis=1)
    assert np.median(apart) < 0.2 and np.quantile(apart, 0.95) < 1.0


def check(width: int | None, fps: float = 25.0) -> TakeCheck:
    return TakeCheck("take", (), (), None if width is None else (width, 240), fps)


def test_an_outlier_among_many_is_flagged() -> None:
    warned = flag_outliers([check(320), check(320), check(640), check(320), check(320, 30.0), check(None)])
    assert [len(one.warnings) for one in warned] == [0, 0, 1, 0, 1, 0]
    assert "640 x 240 pixels" in warned[2].warnings[0] and "25 frames per second" in warned[4].warnings[0]


@pytest.mark.parametrize("widths", [(320, 320, 320, 640), (320, 320, 320, 640, 640, 640)])
def test_without_a_usual_value_there_is_no_outlier(widths: tuple[int, ...]) -> None:
    assert all(one.warnings == () for one in flag_outliers([check(width) for width in widths]))
