"""The command of a detector: words and placeholders, never a shell's."""

import json
import os
import sys
from pathlib import Path

import pytest
from keymark.core.errors import InputError
from keymark.operators.bridge.detector.detector_command import FOLDER, PLACEHOLDERS, parse_command

VALUES = {name: f"<{name}>" for name in PLACEHOLDERS}


def call(text: str, **values: str) -> list[str]:
    """The words of one call after the program, which is this Python."""
    return parse_command(text, "--detector").call({**VALUES, **values})[1:]


def test_words_are_split_filled_in_and_never_split_again() -> None:
    """A clip whose name holds spaces, quotes, braces and a shell's signs stays one word."""
    odd = "/odd/a b'c\"{output}; rm -rf $HOME `x`|.mp4"
    words = call(f'"{sys.executable}" -u {{clip}} --output={{output}} "two words" {{{{x}}}}', clip=odd)
    assert words == ["-u", odd, "--output=<output>", "two words", "{x}"]
    listed = json.dumps([sys.executable, "{clip}", "a b", "", "{width}x{height}"])
    assert call(listed) == ["<clip>", "a b", "", "<width>x<height>"]


def test_what_comes_with_keymark_is_there() -> None:
    """`{detectors}` leads to the program that comes along."""
    assert (FOLDER / "mediapipe_pose.py").is_file()
    assert call(f"'{sys.executable}' {{detectors}}/x {{clip}}", detectors=str(FOLDER))[0] == f"{FOLDER}/x"


def test_relative_paths_of_files_get_whole_since_the_program_runs_elsewhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Files and folders that are there; not words that only look like names."""
    (tmp_path / "models").mkdir()
    (tmp_path / "detect.py").touch()
    (tmp_path / "full").touch()
    monkeypatch.chdir(tmp_path)
    words = call(f"'{sys.executable}' detect.py --model full ./models other.py 1.5 {{clip}}")
    assert words == [str(tmp_path / "detect.py"), "--model", "full", str(tmp_path / "models"), "other.py"] + [
        "1.5",
        "<clip>",
    ]


def test_a_program_is_found_by_name_and_called_by_its_script() -> None:
    """Sentences name the script rather than its interpreter."""
    program = parse_command("sh {clip}", "").call(VALUES)[0]
    assert os.path.isabs(program) and os.path.basename(program) == "sh"
    assert parse_command("/usr/bin/python3.11 /a/b/find.py {clip}", "").name == "find.py"
    assert parse_command("/opt/openpose.bin --video {clip}", "").name == "openpose.bin"


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "names no program"),
        ("   ", "names no program"),
        ("[]", "names no program"),
        ('["", "{clip}"]', "names no program"),
        ("program", "has no {clip}"),
        ("program {clip} {outptu}", "'{outptu}' in '{outptu}' is unknown"),
        ("program {clip.__class__}", "is unknown"),
        ("program {clip!r} x", "is unknown"),
        ("program {clip} {", "'{' in '{' is unknown"),
        ("program '{clip}", "a quote is opened and not closed"),
        ("program {clip} | tee log", "'|' is for a shell"),
        ("program {clip} > {output}", "'>' is for a shell"),
        ("[1, 2]", "holds 1, which is no text"),
        ('["program", "{clip}"', "is no valid JSON"),
        ('["program", "{clip}", "a\\u0000b"]', "control character"),
        ("program {clip}\nrm", "control character"),
        ("program {clip} " + "x" * 9000, "at most 8000"),
    ],
)
def test_an_unusable_command_is_told_in_one_sentence(text: str, said: str) -> None:
    """The sentence begins with where the command was set."""
    with pytest.raises(InputError) as caught:
        parse_command(text, "KEYMARK_DETECTOR")
    assert str(caught.value).startswith("KEYMARK_DETECTOR: ") and said in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_program_that_is_not_there_or_no_program_is_told(tmp_path: Path) -> None:
    """Missing, a folder, and a file without the right to be executed."""
    plain = tmp_path / "plain.txt"
    plain.write_text("no program")
    for word, said in [("/nowhere/x", "nowhere"), (str(tmp_path), "is a folder"), (str(plain), "executed")]:
        with pytest.raises(InputError, match=said):
            parse_command(f"{word} {{clip}}", "--detector").check_program()
