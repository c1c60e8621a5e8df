"""A wall panel of a sleeve's color: the check names the field that leaves it out, and with it all is well."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from _panelled_take import PANEL, SLEEVE, panelled_take
from keymark.core.progress import run
from keymark.core.shoot.check.evidence_check import Findings
from keymark.core.shoot.check.footage_check import check_footage
from keymark.core.take.clip_check import open_clip
from keymark.core.take.read_footage import read_footage
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

PROPOSAL = re.compile(r"still areas have the color of (.*); they are left out where take.json says \{?(.*)")


@pytest.fixture(scope="module")
def folder(repository: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    demo = repository / "presets" / "demo" / "aerobic"
    return panelled_take(demo, tmp_path_factory.mktemp("panelled") / "take")


def warnings(take: Take) -> tuple[str, ...]:
    findings, clip = Findings(), open_clip(take)
    check_footage(take, clip, clip.frame_count, findings)
    assert not findings.problems
    return findings.warnings


def said(take: Take) -> dict[str, object]:
    (proposal,) = (sentence for sentence in warnings(take) if "they are left out" in sentence)
    names, field = PROPOSAL.match(proposal).groups()  # type: ignore[union-attr]
    assert names == SLEEVE
    return dict(json.loads("{" + field + "}"))


def test_the_check_names_what_take_json_must_say(folder: Path) -> None:
    proposed = said(read_take(folder))
    ((region,),) = proposed.values()
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
    file.write_text(json.dumps(fields), encoding="utf-8")


def test_a_sleeve_is_followed_as_if_there_were_no_panel(folder: Path, repository: Path) -> None:
    plain = run(read_footage(read_take(repository / "presets" / "demo" / "aerobic"))).tracks
    file = folder / "take.json"
    fields = json.loads(file.read_text(encoding="utf-8"))
    file.write_text(json.dumps({**fields, **said(read_take(folder))}), encoding="utf-8")
    left_out = run(read_footage(read_take(folder))).tracks
    file.write_text(json.dumps(fields), encoding="utf-8")
    row = plain.names.index(SLEEVE)
    both = plain.visible[:, row] & left_out.visible[:, row]
    assert both.sum() >= plain.visible[:, row].sum() - 2
    apart = np.linalg.norm(plain.centroid[both, row] - left_out.centroid[both, row], axis=1)
    assert np.median(apart) < 0.2 and np.quantile(apart, 0.95) < 1.0
