"""Pages of the docs agree with the code: limits are the readers', nothing is left out, examples are read."""

import argparse
import json
import re
from pathlib import Path

import numpy as np
import pytest
from _boot import ROOT
from _house import all_sentences, sentences, without_names
from _synthetic_take import write_synthetic_take
from keymark.core import MOST_FRAMES, MOST_PIXELS
from keymark.core.body import posture
from keymark.core.camera import camera_fields
from keymark.core.detect import detected_frames, detector_formats, keypoint_file
from keymark.core.detect.keypoints import BODY_POINTS
from keymark.core.detect.layouts import LAYOUTS
from keymark.core.files import json_file, kinds
from keymark.core.markers import ignored_regions
from keymark.core.prior import library, texts
from keymark.core.retarget import retarget_record
from keymark.core.retarget.character import LIMBS, ROLES, SOURCES
from keymark.core.retarget.maps import character_map
from keymark.core.shoot import discovery
from keymark.core.take import (
    conversion_record,
    conversion_settings,
    description,
    keyframe_file,
    motion,
    take_file,
)
from keymark.operators.cli.commands.character import character_command
from keymark.operators.cli.commands.retarget import retarget_command

PATH = re.compile(r"(?:core|operators|tests|presets|tools|benchmarks|docs)/[\w/.]*\w")
NOTES = re.compile(r"^\| it says \|.*\n\|[-|]+\|\n((?:\|.*\n)+)", re.MULTILINE)
LINK = re.compile(r"\]\(([\w.]*)#([\w-]+)\)")


def page(name: str) -> str:
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def example(text: str, folder: Path, name: str) -> Path:
    """The only example of a page, as a file."""
    (found,) = re.findall(r"```json\n(.*?)```", text, flags=re.DOTALL)
    (folder / name).write_text(found, encoding="utf-8")
    return folder / name


def mib(*modules: object) -> str:
    """The largest file that all these modules read."""
    (size,) = {getattr(module, "LARGEST_BYTES", None) or module.LONGEST_LINE_BYTES for module in modules}  # type: ignore[attr-defined]
    return f"{size // 2**20} MiB"


FORMATS = {
    "`take.json`, `keyframes.json`, `truth.json`, a list of takes": mib(json_file, discovery),
    "`motion.json`": mib(motion),
    "a library, `conversion.json`, `retarget.json`": mib(library, conversion_record, retarget_record),
    "a file of keypoints; a file of a detector's folder": (
        f"{mib(keypoint_file)}; {detector_formats.LARGEST_FILE_BYTES // 2**20} MiB"
    ),
    "`shoot.json`, a line of a list, a character map": mib(description, character_map),
    "lists and objects in a file": f"{json_file.MOST_LISTS}, {json_file.DEEPEST} levels deep",
    "a path; a name in it": f"{kinds.LONGEST_PATH} characters; {kinds.LONGEST_NAME_BYTES} bytes",
    "takes of a shoot": f"{discovery.MOST_TAKES}",
    "frames of a take": f"{MOST_FRAMES}",
    "keyframes of a take": f"{keyframe_file.MOST_KEYFRAMES}",
    "markers of a take; a marker's name": (
        f"{take_file.MOST_MARKERS}; {take_file.LONGEST_MARKER_NAME} characters"
    ),
    "ignored regions of a take; points of a stroke": (
        f"{ignored_regions.MOST_REGIONS}; {ignored_regions.MOST_POINTS}"
    ),
    "files of keypoints of a take": f"{conversion_settings.MOST_KEYPOINT_FILES}",
    "width, height of a clip's pictures; pixels of one": f"{camera_fields.LARGEST_SIDE_PX}; {MOST_PIXELS}",
    "images of a sequence": f"{MOST_FRAMES}",
    "distance of keyframes from the origin": f"{posture.FARTHEST_M:.0f} m",
    "distance of cameras from the origin": f"{camera_fields.FARTHEST_M:.0f} m",
}
KEYPOINTS = {
    "a file": mib(keypoint_file),
    "a file of a detector's folder": f"{detector_formats.LARGEST_FILE_BYTES // 2**20} MiB",
    "frames; numbered files of a folder": f"{MOST_FRAMES}",
    "people in a frame": f"{detected_frames.MOST_PEOPLE}",
    "points of all people in all frames": f"{detected_frames.MOST_POINTS}",
    "distance of a point from the picture's corner; of a guess from the hips": (
        f"{detected_frames.FARTHEST_PX:g} px; {detected_frames.FARTHEST_M:g} m"
    ),
}
LIMITS = {
    "formats": [f"| {what} | {limit} |" for what, limit in FORMATS.items()],
    "keypoint_format": [f"| {what} | {limit} |" for what, limit in KEYPOINTS.items()],
    "character_map_format": [
        f"| {texts.LONGEST_NAME} characters |",
        f"| {character_map.MOST_SETTINGS} |",
        f"| {character_map.MOST_SOLE_POINTS} points each |",
        f"up to {character_map.LONGEST_BONE} characters",
        f"1 to {character_map.MOST_BONES}, from the hips",
        f"above {mib(character_map)}",
    ],
    "library_format": [
        f"1 to {texts.LONGEST_IDENTIFIER} of a-z",
        f"| {texts.LONGEST_NAME} characters |",
        f"1 to {library.HIGHEST_VERSION} |",
        f"{texts.LONGEST_LINE} characters",
        f"{texts.LONGEST_LICENSE} characters",
        f"{texts.LONGEST_TEXT} characters",
        f"{texts.MOST_TAGS} tags of {texts.LONGEST_TAG} characters",
        f"{library.MOST_SOURCES} sources of {texts.LONGEST_TEXT}",
        f"{library.MOST_MOTIONS}, together {library.MOST_STEPS} steps",
        f"1 to {library.MOST_POSTURES} |",
        f"({library.SHORTEST_S:g} to {library.LONGEST_S:g} s)",
        f"above {mib(library)}",
    ],
}


@pytest.mark.parametrize("name", LIMITS)
def test_limits_are_those_of_the_readers(name: str) -> None:
    text = page(name)
    assert [words for words in LIMITS[name] if words not in text] == []


def test_the_page_on_architecture_names_every_room_and_paths_that_exist() -> None:
    text = page("architecture")
    named = set(PATH.findall(text))
    assert len(named) > 8
    assert [name for name in sorted(named) if not (ROOT / name).exists()] == []
    tops = re.split(r"^operators/", text.split("```")[1], flags=re.MULTILINE)
    for top, section in zip(("core", "operators"), tops, strict=True):
        section = section.split("\npresets/")[0]
        lines = re.findall(r"^   (?=\w)(.*?)(?:   |$)", section, flags=re.MULTILINE)
        rooms = {name for line in lines for name in re.findall(r"(\w+)/", line)}
        assert rooms == {path.parent.name for path in (ROOT / top).glob("*/__init__.py")}


def test_formats_have_a_row_for_every_schema_and_editor_settings_that_exist(tmp_path: Path) -> None:
    text = page("formats")
    schemas = {path.name.removesuffix(".schema.json") for path in (ROOT / "presets" / "schemas").iterdir()}
    rows = re.findall(r"\| `([a-z]+)`(?:, each line)? \|", text.split("## What is refused")[0])
    assert set(rows) == schemas
    for entry in json.loads(example(text, tmp_path, "settings.json").read_text())["json.schemas"]:
        assert (ROOT / entry["url"].removeprefix("./keymark/")).is_file()


def test_keypoints_have_every_field_layout_and_point_and_an_example(tmp_path: Path) -> None:
    text = page("keypoint_format")
    schema = json.loads((ROOT / "presets/schemas/keypoints.schema.json").read_text(encoding="utf-8"))
    table = text.split("## Keymark's own file")[1].split("Other fields")[0]
    assert set(re.findall(r"^\| `(\w+)` \|", table, flags=re.MULTILINE)) == set(schema["properties"])
    rows = dict(re.findall(r"^\| `(\w+)` \| (\d+) \|", text, flags=re.MULTILINE))
    assert rows == {name: str(layout.count) for name, layout in LAYOUTS.items()}
    sentence = text.split("The names are")[1].split("The same name")[0]
    assert set(re.findall(r"`(\w+)`", sentence)) == {name.partition(".")[0] for name in BODY_POINTS}
    given = example(text, tmp_path, "keypoints.json")
    people = keypoint_file.read_keypoints(given, 3, (1280, 720), 30.0, 1)
    assert [len(frame.pixel) for frame in people.frames] == [1, 0, 1] and people.notes == ()
    np.testing.assert_array_equal(people.frames[2].pixel[0], [[655.9, 601.3], [np.nan, np.nan]])
    assert people.frames[0].hint_m[0, 1].tolist() == [0.01, 0.88, -0.08]


def test_libraries_have_every_field_and_an_example_laid_out_as_one(tmp_path: Path) -> None:
    text = page("library_format")
    assert [name for name in library.Library.ORDER if f"`{name}`" not in text.split("## A posture")[0]] == []
    given = example(text, tmp_path, "given.json")
    nodding = library.read_library(given)
    library.write_library(tmp_path / "nodding.json", nodding)
    assert (tmp_path / "nodding.json").read_bytes() == given.read_bytes()
    assert nodding.motions[0].cyclic


def test_character_maps_have_every_field_and_role_and_an_example_laid_out_as_one(tmp_path: Path) -> None:
    text = page("character_map_format")
    header = text.split("## The map")[1].split("## Roles")[0]
    assert [name for name in character_map.CharacterMap.ORDER if f"`{name}`" not in header] == []
    parts = {role.partition(".")[0] for role in ROLES}
    assert [name for name in (*parts, *LIMBS, *SOURCES) if f"`{name}`" not in text] == []
    given = example(text, tmp_path, "given.json")
    anna = character_map.read_character_map(given)
    character_map.write_character_map(tmp_path / "anna.json", anna)
    assert (tmp_path / "anna.json").read_bytes() == given.read_bytes()
    assert anna.roles["foot.L"].confidence == 0.6 and anna.settings[1].value is True


def test_characters_have_every_option_and_field_and_an_example(tmp_path: Path) -> None:
    text = page("characters")
    for command in (character_command, retarget_command):
        parser = argparse.ArgumentParser()
        for names, settings in command.arguments:
            parser.add_argument(*names, **settings)
        options = [action.option_strings for action in parser._actions if action.option_strings]
        known = ("--help", "--replace")
        assert [names for names in options if not any(name in text or name in known for name in names)] == []
    assert [end for end in conversion_settings.CHARACTER_ENDINGS if f"`{end}`" not in text] == []
    section = text.split("## In a shoot")[1]
    assert [name for name in conversion_settings.CharacterSettings.ORDER if f"`{name}`" not in section] == []
    assert f"{conversion_settings.RetargetOptions().tolerance_mm:g} by default" in section
    example(section, tmp_path, "shoot.json")
    said = description.describe(write_synthetic_take(tmp_path / "take", 3)).settings.character
    assert said is not None and said.object == "rig" and said.options.tolerance_mm == 2.0
    assert said.options.legs == "ik" and said.map_file == tmp_path / "cast" / "anna.json"


def notes(text: str) -> list[list[str]]:
    """The rows of the tables of notes and warnings on troubleshooting."""
    lines = [line for table in NOTES.findall(text) for line in table.splitlines()]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def unsaid(text: str, said: set[str]) -> list[str]:
    """Sentences of the page that nobody says; names of values do not count."""
    told = [row[0].strip("`") for row in notes(text)]
    assert len(told) == len(set(told)) > 0
    return sorted(sentence for sentence in told if without_names(sentence) not in said)


def test_troubleshooting_has_sentences_that_are_said_and_says_what_to_do() -> None:
    text = page("troubleshooting")
    assert unsaid(text, all_sentences(ROOT)) == []
    assert [row for row in notes(text) if len(row) != 3 or not all(row)] == []
    made_up = "| it says | why | what to do |\n|---|---|---|\n| `{a} of {b}` | x | y |\n| `gone` | x | y |\n"
    assert unsaid(made_up, set(sentences('f"{first + 1} of {total:.1f}"'))) == ["gone"]


def test_links_of_troubleshooting_lead_to_headings() -> None:
    text = page("troubleshooting")
    found = LINK.findall(text)
    assert len(found) > 5
    for file, anchor in found:
        headings = re.findall(
            r"^#+ (.*)$", page(file.removesuffix(".md") or "troubleshooting"), flags=re.MULTILINE
        )
        known = {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}
        assert anchor in known, f"{file}#{anchor}"
    for file in re.findall(r"\]\(([\w.]+\.md)\)", text):
        assert (ROOT / "docs" / file).is_file(), file
