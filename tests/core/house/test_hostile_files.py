"""Hostile files of every format: each is read, or refused with one sentence."""

import json
import os
import shutil
import socket
import warnings
from pathlib import Path

import pytest
from _formats import Format, formats
from _fuzz import FUZZ, changed, encoded, files, is_sentence
from _synthetic_take import write_synthetic_take
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from keymark.core.errors import InputError
from keymark.core.files.json_file import DEEPEST, MOST_LISTS, parse_json, read_json
from keymark.operators.cli.main import main

FRAMES = 6
NAMES = (
    *("take", "keyframes", "shoot", "takes", "library", "character", "motion", "conversion", "retarget"),
    *("keypoints", "truth"),
)
FAST = ("--method", "interpolation", "--no-report", "--quiet")


@pytest.fixture(scope="module")
def known(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Format]:
    return formats(tmp_path_factory.mktemp("formats"))


@pytest.fixture(scope="module")
def pristine(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_synthetic_take(tmp_path_factory.mktemp("takes") / "pristine", FRAMES, 3)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.fuzz
@settings(max_examples=25 * FUZZ, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_any_content_is_read_or_refused(known: dict[str, Format], name: str, data: st.DataObject) -> None:
    content = data.draw(files(known[name].valid))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            known[name].read(content)
        except InputError as error:
            assert is_sentence(" ".join(str(error).split())) and ".json" in str(error)


def tree(folder: Path) -> dict[str, bytes | None]:
    """Contents by path of all files below a folder; links are not followed."""
    return {
        str(path.relative_to(folder)): path.read_bytes() if path.is_file() and not path.is_symlink() else None
        for path in sorted(folder.rglob("*"))
    }


def converts(take: Path, output: Path, capfd: pytest.CaptureFixture[str]) -> bool:
    """Convert, assert the rules for messages and files left behind, and return whether it succeeded."""
    output.mkdir(exist_ok=True)
    (output / "mine.txt").write_text("mine", encoding="utf-8")
    before, inputs = tree(output), tree(take) if take.is_dir() else {}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        status = main(["convert", str(take), "--output", str(output), *FAST])
    said = capfd.readouterr()
    assert status in (0, 1, 2) and said.out == ""
    assert inputs == (tree(take) if take.is_dir() else {})
    if status == 0:
        assert said.err == "" and (output / "motion.json").is_file()
        return True
    assert len(said.err.splitlines()) == 1 and is_sentence(said.err.strip(), 3000)
    assert "unexpectedly" not in said.err and "Traceback" not in said.err
    assert tree(output) == before
    return False


def changed_take(pristine: Path, take: Path, data: st.DataObject) -> None:
    """Replace the last example's take by one with a changed file."""
    shutil.rmtree(take, ignore_errors=True)
    shutil.copytree(pristine, take)
    name = data.draw(st.sampled_from(["take.json", "keyframes.json"]))
    valid = json.loads((take / name).read_text(encoding="utf-8"))
    (take / name).write_bytes(encoded(data.draw, data.draw(changed(valid, 2))))


@pytest.mark.usefixtures("no_blender")
@pytest.mark.fuzz
@settings(max_examples=10 * FUZZ, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_a_mutated_take_converts_or_is_refused(
    pristine: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], data: st.DataObject
) -> None:
    changed_take(pristine, tmp_path / "take", data)
    shutil.rmtree(tmp_path / "out", ignore_errors=True)
    converts(tmp_path / "take", tmp_path / "out", capfd)


@pytest.mark.fuzz
@settings(max_examples=10 * FUZZ, suppress_health_check=list(HealthCheck))
@given(data=st.data())
def test_reading_commands_report_errors(
    pristine: Path, tmp_path: Path, capfd: pytest.CaptureFixture[str], data: st.DataObject
) -> None:
    changed_take(pristine, tmp_path / "shoot" / "take", data)
    command = data.draw(st.sampled_from(["check", "propose", "library check"]))
    path = {
        "check": tmp_path / "shoot",
        "propose": tmp_path / "shoot" / "take",
        "library check": tmp_path / "shoot" / "take" / "take.json",
    }[command]
    before = tree(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        status = main([*command.split(), str(path)])
    said = capfd.readouterr()
    assert status in (0, 1, 2) and len(said.err.splitlines()) == bool(status)
    assert "unexpectedly" not in said.err + said.out and "Traceback" not in said.err + said.out
    assert tree(tmp_path) == before


@pytest.mark.parametrize("name", ["clip", "keyframes.json", "take.json", "frames/0002.png"])
@pytest.mark.parametrize("kind", ["pipe", "socket", "device", "folder", "outside", "loop"])
@pytest.mark.usefixtures("no_blender")
def test_special_files_do_not_block(
    pristine: Path,
    tmp_path: Path,
    name: str,
    kind: str,
    capfd: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    take = Path(shutil.copytree(pristine, tmp_path / "take"))
    path = take / name
    if name == "clip":
        path = take / "clip.mp4"
        said = json.loads((take / "take.json").read_text(encoding="utf-8"))
        (take / "take.json").write_text(json.dumps(said | {"clip": "clip.mp4"}), encoding="utf-8")
    path.unlink(missing_ok=True)
    secret = tmp_path / "secret" / path.name
    secret.parent.mkdir()
    if (pristine / name).is_file():
        shutil.copyfile(pristine / name, secret)
    try:
        if kind == "pipe":
            os.mkfifo(path)
        elif kind == "socket":
            monkeypatch.chdir(path.parent)  # its path may be no longer than a hundred letters
            with socket.socket(socket.AF_UNIX) as one:
                one.bind(path.name)
        elif kind == "folder":
            path.mkdir()
        else:
            path.symlink_to({"device": Path("/dev/zero"), "outside": secret, "loop": path}[kind])
    except (OSError, AttributeError, NotImplementedError):
        pytest.skip("this system has no such thing")
    monkeypatch.chdir(tmp_path)
    missing = name == "frames/0002.png" and kind not in ("device", "outside")  # an image that is not there
    assert converts(take, tmp_path / "out", capfd) == missing


HUGE: dict[str, bytes] = {
    "deep": b'{"a": ' + b"[" * 100_000,
    "deep and closed": b'{"a": ' + b"[" * (DEEPEST + 1) + b"]" * (DEEPEST + 1) + b"}",
    "many lists": b'{"a": [' + b"[]," * MOST_LISTS + b"[]]}",
    "large number": b'{"a": ' + b"9" * 100_000 + b"}",
    "tiny number": b'{"a": 1e' + b"9" * 100_000 + b"}",
    "half a character": b'{"a": "\\ud800"}',
    "half a character in a name": b'{"\\udfff": 0}',
    "UTF-16": '{"a": 0}'.encode("utf-16"),
    "nothing": b"",
}


@pytest.mark.parametrize("kind", HUGE)
def test_excessive_json_is_refused(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "huge.json"
    path.write_bytes(HUGE[kind])
    with pytest.raises(InputError, match=r"huge\.json") as caught:
        read_json(path)
    assert is_sentence(str(caught.value), 400 + len(str(path)))


def test_brackets_in_strings_are_not_nesting() -> None:
    text = json.dumps({"a": "[" * 500 + '"\\' + "{" * 500, "b": [[1]]})
    assert parse_json(text, "here")["b"] == [[1]]
    assert parse_json('{"a": "\\ud83c\\udfac"}', "here")["a"] == "\U0001f3ac"
