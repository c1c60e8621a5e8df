"""Several people in one motion file: one of them whole; and texts that other systems saved."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from _performances import stepping, write_mhr70
from keymark.core.arrays import Array
from keymark.core.body.human import HUMAN
from keymark.core.errors import InputError
from keymark.core.take.point_files import read_bvh, read_points, write_c3d, write_trc
from keymark.core.take.reference import read_reference

Write = Callable[..., None]
FRAMES = 12
APART = np.array([0.5, 0.3, 0.0])


@pytest.fixture(scope="module")
def points() -> Array:
    body, posture = stepping()
    return np.asarray(body.points(body.pose(posture[:FRAMES])))


def write_people(
    write: Write, path: Path, points: Array, people: dict[str, set[str]], gaps: tuple[str, ...] = ()
) -> Path:
    """Write the same points for each person, half a meter apart, without those that each lacks."""
    names, columns = [], []
    for number, (prefix, lacking) in enumerate(people.items()):
        for index, name in enumerate(HUMAN.point_names):
            if name not in lacking:
                stem, _, side = name.partition(".")
                own = points[:, index] + number * APART
                if prefix in gaps:
                    own = np.where(np.arange(len(own))[:, None] == 5, np.nan, own)
                names.append(f"{prefix}{side.lower()}_{stem}")
                columns.append(own)
    write(path, np.stack(columns, axis=1), 30.0, names)
    return path


@pytest.mark.parametrize(("write", "ending"), [(write_trc, "trc"), (write_c3d, "c3d")])
@pytest.mark.parametrize(
    ("people", "gaps", "wanted", "taken"),
    [
        ({"A:": set(), "B:": set()}, (), None, 0),
        ({"A:": set(), "B:": set()}, (), "B", 1),
        ({"A:": {"knee.R", "elbow.L"}, "B:": set()}, (), None, 1),
        ({"A:": set(), "B:": {"knee.R", "elbow.L"}}, (), None, 0),
        ({"A:": set(), "B:": set()}, ("A:",), None, 1),
        ({"A:": set(), "B:": set()}, ("A:",), "A", 0),
        ({"": {"head"}, "B:": set()}, (), None, 1),
        ({"Anna_": set(), "Ben_": set()}, (), None, 0),
        ({"Anna_": {"knee.R"}, "Ben_": set()}, (), None, 1),
        ({"Anna_": {"knee.R"}, "Ben-": set()}, (), None, 1),
        ({"Anna/": set(), "Ben:": set()}, (), "ben", 1),
        ({"Anna b ": set(), "Ben|": set()}, (), None, 0),
    ],
)
def test_one_subject_is_taken_whole(
    tmp_path: Path,
    points: Array,
    write: Write,
    ending: str,
    people: dict[str, set[str]],
    gaps: tuple[str, ...],
    wanted: str | None,
    taken: int,
) -> None:
    file = write_people(write, tmp_path / f"two.{ending}", points, people, gaps)
    found, _, notes = read_points(file, wanted)
    expected = points + taken * APART
    if list(people)[taken] in gaps:
        expected[5] = np.nan
    np.testing.assert_allclose(found, expected, atol=1e-5)
    names = [prefix.rstrip(":_-/| ") or "(no prefix)" for prefix in people]
    said = f"2 subjects, '{names[0]}', '{names[1]}'; the motion is that of '{names[taken]}'"
    assert (notes == ()) if wanted else (said in notes[0])
    assert read_reference(file, wanted).notes == notes


def test_two_spellings_of_a_prefix_are_one_person(tmp_path: Path, points: Array) -> None:
    arms = {name for name in HUMAN.point_names if name[:2] in ("sh", "el", "wr", "he")}
    people = {"Anna b:": arms, "Anna_b:": {*HUMAN.point_names} - arms}
    file = write_people(write_trc, tmp_path / "spelled.trc", points, people)
    file.write_text(file.read_text().replace("Anna_b", "ANNA_B "))
    found, _, notes = read_points(file)
    moved = np.array([[0.0] * 3 if name not in arms else APART for name in HUMAN.point_names])
    np.testing.assert_allclose(found, points + moved, atol=1e-5)
    assert notes == ()


def test_no_whole_subject_and_a_wrong_name_are_one_sentence(tmp_path: Path, points: Array) -> None:
    lacking = {"A:": {"knee.R"}, "B:": {"elbow.L"}}
    file = write_people(write_trc, tmp_path / "parts.trc", points, lacking)
    with pytest.raises(
        InputError, match=r"none of its 2 subjects has all points; .*'A' knee\.R; 'B' elbow\.L"
    ):
        read_points(file)
    with pytest.raises(InputError, match=r"has no subject 'C'; its subjects are 'A', 'B'"):
        read_points(file, "C")
    with pytest.raises(InputError, match=r"has no point for elbow\.L"):
        read_points(file, "B")
    write_trc(tmp_path / "one.trc", points, 30.0)
    with pytest.raises(InputError, match="its points have no prefixes"):
        read_points(tmp_path / "one.trc", "A")


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "utf-16-le", "cp932"])
@pytest.mark.parametrize("ending", ["trc", "csv"])
def test_texts_of_other_systems_are_read(tmp_path: Path, points: Array, encoding: str, ending: str) -> None:
    file = tmp_path / f"saved.{ending}"
    if ending == "trc":
        write_trc(file, points, 30.0, title="歩く")
        text = file.read_text(encoding="utf-8").replace(".", ",")
    else:
        write_mhr70(file, points)
        header, *rows = file.read_text().splitlines()
        text = "\n".join(
            ["sep=;", header.replace(",", ";"), *(row.replace(",", ";").replace(".", ",") for row in rows)]
        )
    file.write_bytes(text.encode(encoding))
    np.testing.assert_allclose(read_points(file)[0], points, atol=2e-6)


def test_commas_between_columns_and_in_numbers_are_named(tmp_path: Path, points: Array) -> None:
    file = tmp_path / "commas.csv"
    write_mhr70(file, points)
    header, *rows = file.read_text().splitlines()
    file.write_text("\n".join([header, *(row.replace(".", ",") for row in rows)]))
    with pytest.raises(InputError, match="has commas between its columns and, as it seems, in its numbers"):
        read_points(file)


def root(name: str, joints: int) -> str:
    """A ROOT with joints one above the other, three channels each and six its own."""
    lines = [f"ROOT {name}", "{", "OFFSET 0 0 0", "CHANNELS 6 Xposition Yposition Zposition Z X Y"]
    for number in range(joints):
        lines += [f"JOINT {name}{number}", "{", "OFFSET 0 1.5 0", "CHANNELS 3 Z X Y"]
    return "\n".join([*lines, "End Site", "{", "OFFSET 0 1.5 0", "}", *["}"] * (joints + 1)])


def bvh(*joints: int) -> str:
    names = "ABC"[: len(joints)]
    hierarchy = "\n".join(map(root, names, joints))
    row = " ".join(f"{number}.25" for number in range(sum(6 + 3 * count for count in joints)))
    return f"HIERARCHY\n{hierarchy}\nMOTION\nFrames: 2\nFrame Time: 0.04\n{row}\n{row}\n"


@pytest.mark.parametrize(
    ("joints", "wanted", "name", "first", "count"),
    [
        ((2, 2), None, "A", 0, 12),
        ((1, 2), None, "B", 9, 12),
        ((1, 2), "A", "A", 0, 9),
        ((1, 3, 2), "C", "C", 24, 12),
        ((2,), None, "A", 0, 12),
    ],
)
def test_one_root_of_a_bvh_is_taken_with_its_own_channels(
    tmp_path: Path, joints: tuple[int, ...], wanted: str | None, name: str, first: int, count: int
) -> None:
    (tmp_path / "two.bvh").write_text(bvh(*joints))
    text, notes = read_bvh(tmp_path / "two.bvh", wanted)
    assert text.count("ROOT ") == 1 and f"ROOT {name}\n" in text and text.count("{") == text.count("}")
    row = " ".join(f"{number}.25" for number in range(first, first + count))
    assert text.endswith(f"Frames: 2\nFrame Time: 0.04\n{row}\n{row}\n")
    assert len(notes) == (len(joints) > 1 and wanted is None)
    assert all(f"the motion is that of '{name}'" in note for note in notes)
    with pytest.raises(InputError, match="has no subject 'Nobody'; its subjects are 'A'"):
        read_bvh(tmp_path / "two.bvh", "Nobody")


def test_the_second_of_two_roots_with_one_name_can_be_named(tmp_path: Path) -> None:
    (tmp_path / "two.bvh").write_text(bvh(2, 3).replace("ROOT B", "ROOT A"))
    assert "2 subjects, 'A', 'A 2'; the motion is that of 'A 2'" in read_bvh(tmp_path / "two.bvh")[1][0]
    for name, joints in (("A", 2), ("A 2", 3), ("a_2", 3)):
        assert read_bvh(tmp_path / "two.bvh", name)[0].count("JOINT") == joints


@pytest.mark.parametrize(
    ("change", "encoding"),
    [
        (lambda text: text, "utf-8-sig"),
        (lambda text: text, "utf-16"),
        (lambda text: text.replace("ROOT A", "ROOT 腰"), "cp932"),
        (lambda text: text.replace(".", ","), "ascii"),
        (lambda text: text.replace("\n", "\r"), "ascii"),
    ],
)
def test_a_bvh_of_another_system_is_read(tmp_path: Path, change: Callable[[str], str], encoding: str) -> None:
    file = tmp_path / "saved.bvh"
    file.write_bytes(change(bvh(2)).encode(encoding))
    text, _ = read_bvh(file)
    assert text.replace("腰", "A") == bvh(2)


def test_other_commas_in_a_bvh_are_named(tmp_path: Path) -> None:
    (tmp_path / "commas.bvh").write_text(bvh(2).replace(".25 ", ".25, "))
    with pytest.raises(InputError, match=r"has '0\.25,' among its numbers; they must have a decimal point"):
        read_bvh(tmp_path / "commas.bvh")
