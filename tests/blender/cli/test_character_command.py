"""`keymark character`: what is recognized, maps written and checked, and bad input in one sentence."""

import json
from dataclasses import replace
from pathlib import Path

import pytest
from _characters import plain_character, plain_map
from _command_line import one_line, tree
from keymark.core.retarget.character import REQUIRED
from keymark.core.retarget.maps.character_map import read_character_map, write_character_map
from keymark.operators.cli.main import main

Out = pytest.CaptureFixture[str]


def said(capfd: Out) -> tuple[str, str]:
    """What was written on standard output and standard error."""
    captured = capfd.readouterr()
    return captured.out, captured.err


def test_it_says_what_plays_which_role(cast: Path, capfd: Out) -> None:
    assert main(["character", str(cast / "anna.blend")]) == 0
    out, err = said(capfd)
    assert err == "" and "'Anna', recognized" in out
    for role, bone in (("hips", "hips"), ("upper_arm.L", "upper_arm.L"), ("shin.R", "shin.R")):
        assert any(line.split()[0] == role and line.endswith(bone) for line in out.splitlines()), role


def test_its_map_can_be_kept_and_used_again(cast: Path, tmp_path: Path, capfd: Out) -> None:
    file = tmp_path / "maps" / "anna.json"
    file.parent.mkdir()
    words = ["character", f"{cast / 'two.blend'}:Anna", "--output", str(file)]
    assert main([*words, "--json"]) == 0
    out, _ = said(capfd)
    answer = json.loads(out)
    assert answer["origin"] == "recognized" and answer["files"] == [str(file)] and answer["object"] == "Anna"
    found = read_character_map(file)
    assert set(REQUIRED) <= set(found.roles)
    before = file.read_bytes()
    assert main(words) == 2
    assert "is there already" in one_line(said(capfd)[1]) and file.read_bytes() == before
    assert main([*words, "--replace", "--quiet"]) == 0 and file.read_bytes() == before
    assert main(["character", str(cast / "anna.blend"), "--map", str(file), "--json"]) == 0
    checked = json.loads(said(capfd)[0])
    assert checked["origin"] == "given" and checked["map_file"] == str(file)
    assert checked["map"] == json.loads(before)


def test_a_saved_map_is_found_by_the_bones(
    cast: Path, tmp_path: Path, capfd: Out, monkeypatch: pytest.MonkeyPatch
) -> None:
    write_character_map(tmp_path / "own.json", replace(plain_map(plain_character()), title="Studio"))
    monkeypatch.setenv("KEYMARK_LIBRARIES", str(tmp_path))
    assert main(["character", str(cast / "anna.blend")]) == 0
    assert f"by the saved map Studio ({tmp_path / 'own.json'})" in said(capfd)[0]
    assert main(["character", str(cast / "anna.blend"), "--map", "none"]) == 0
    assert "recognized" in said(capfd)[0]
    assert main(["character", str(cast / "anna.blend"), "--map", "studio"]) == 0
    assert "has all bones of the map Studio" in said(capfd)[0]


BAD = {
    "none.blend": "holds no armature",
    "two.blend": "holds 2 armatures, 'Anna', 'Ben'; name one, as in",
    "two.blend:Carl": "'Carl' is not in it; its armatures are 'Anna', 'Ben'",
    "horse.blend": "its trunk does not stand upright on its legs",
    "half.blend": "a character stands on two legs and has two arms",
    "motion.blend": "is an actor of Keymark",
    "flat.blend": "scale",
    "nan.blend": "scale",
    "damaged.blend": "Blender cannot read it as a character",
    "damaged.glb": "Blender cannot read it as a character",
    "missing.blend": "no such file; it must be a character file",
    "anna.obj": "names no character; it must be a file that ends in",
}


@pytest.mark.parametrize("text", BAD)
@pytest.mark.parametrize("command", ["character", "retarget"])
def test_bad_characters_are_one_sentence(
    cast: Path, result: Path, tmp_path: Path, capfd: Out, command: str, text: str
) -> None:
    output = tmp_path / "out"
    output.mkdir()
    (output / "mine.txt").write_text("mine", encoding="utf-8")
    before, inputs = tree(tmp_path), tree(cast)
    words = [command, str(cast / text)] if command == "character" else ["retarget", str(result)]
    words += ["--character", str(cast / text)] if command == "retarget" else []
    words += ["--output", str(output / "map.json" if command == "character" else output), "--quiet"]
    assert main(words) == 2
    out, err = said(capfd)
    sentence = one_line(err)
    assert BAD[text] in sentence and text.partition(":")[0] in sentence, sentence
    assert out == "" or text == "damaged.glb"  # whose importer prints into pytest's own stream
    assert "unexpectedly" not in sentence and len(sentence) < 700
    assert tree(tmp_path) == before and tree(cast) == inputs
