"""Libraries: found by name, and transferred to other proportions."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _libraries import ACTOR, random_posture, small_library
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.prior.library import leg_length_m, transferred, write_library
from keymark.core.prior.registry import find_library, identifier_of, library_path, registered_libraries

LIBRARY = small_library()


@pytest.fixture
def folders(tmp_path: Path) -> list[Path]:
    """Own libraries before shipped ones: `small_steps` in both, `walk` in the second; one is not there."""
    own, shipped = tmp_path / "own", tmp_path / "shipped"
    write_library(own / "small_steps.json", replace(LIBRARY, version=1, title="Mine"))
    write_library(shipped / "small_steps.json", LIBRARY)
    write_library(shipped / "walk.json", replace(LIBRARY, identifier="walk", title="A walk"))
    return [own, tmp_path / "nowhere", shipped]


def test_the_earliest_folder_counts(folders: list[Path]) -> None:
    registered = registered_libraries(folders)
    assert [(identifier_of(entry), entry.title, entry.content.version) for entry in registered] == [
        ("walk", "A walk", 3),
        ("small_steps", "Mine", 1),
    ]
    assert registered[1].path.parent == folders[0]


def test_within_a_folder_the_newest_counts(folders: list[Path]) -> None:
    write_library(folders[0] / "a copy.json", replace(LIBRARY, version=2, title="Newer"))
    assert find_library("small_steps", folders).title == "Newer"


def test_a_broken_file_says_what_is_wrong_and_hides_nothing(folders: list[Path]) -> None:
    (folders[0] / "broken.json").write_text('{"schema": "keymark-library", ')
    (folders[0] / "notes.txt").write_text("no library")
    (folders[0] / "folder.json").mkdir()
    broken = next(entry for entry in registered_libraries(folders) if entry.content is None)
    assert (
        identifier_of(broken) == "broken" and "no valid JSON" in broken.problem and "\n" not in broken.problem
    )
    assert len(registered_libraries(folders)) == 3
    with pytest.raises(InputError, match="no valid JSON"):
        find_library("broken", folders)


def test_libraries_are_found_by_name_and_by_file(folders: list[Path]) -> None:
    assert find_library("WALK", folders).identifier == "walk"
    assert find_library("a walk", folders).identifier == "walk"
    assert find_library(folders[2] / "small_steps.json", folders).title == LIBRARY.title
    assert find_library(str(folders[2] / "small_steps.json"), []).title == LIBRARY.title


@pytest.mark.parametrize("name", ["walking", "../walk", "", "walk/../../secret", "x" * 10**5, "no\nsuch"])
def test_an_unknown_name_is_one_sentence(folders: list[Path], name: str) -> None:
    with pytest.raises(InputError) as caught:
        find_library(name, folders)
    assert len(str(caught.value).splitlines()) == 1
    if name == "walking":
        assert "'walk' meant" in str(caught.value) and "small_steps" in str(caught.value)


@pytest.mark.parametrize(
    "identifier", ["../x", "a/b", "C:x", "con", "nul.x", "Walk", ".walk", "walk.", "", "a b", "auto"]
)
def test_a_librarys_file_stays_in_its_folder(tmp_path: Path, identifier: str) -> None:
    assert library_path(tmp_path, "walk.2_b-c") == tmp_path / "walk.2_b-c.json"
    with pytest.raises(InputError, match="identifier"):
        library_path(tmp_path, identifier)


def test_a_name_counts_before_a_title(folders: list[Path]) -> None:
    write_library(folders[0] / "a.json", replace(LIBRARY, identifier="zebra", title="walk"))
    (folders[0] / "walk.json").write_text("{")
    assert find_library("walk", folders).identifier == "walk"
    assert find_library("A walk", folders).identifier == "walk"


OWN = Body(ACTOR)
LENGTHS = dict(ACTOR.segments_m)


def grounded(seed: int, height_m: float) -> Posture:
    """A posture whose lowest sole is `height_m` above the floor."""
    posture = random_posture(seed)
    lift = height_m - sole_heights_m(OWN, OWN.pose(posture)).min()
    return Posture(HUMAN, posture.translation + [0.0, 0.0, lift], posture.rotations, posture.angles)


@pytest.mark.parametrize(
    "lengths",
    [
        dict(Actor.from_stature(1.5).segments_m),
        LENGTHS | {"shin.L": 0.5, "shin.R": 0.5, "foot.L": 0.25, "foot.R": 0.25},
        LENGTHS | {"thigh.L": 0.3, "trunk": 0.7},
    ],
)
@pytest.mark.parametrize("height_m", [0.0, 0.2])
def test_feet_stay_on_the_floor_or_as_far_above(lengths: dict[str, float], height_m: float) -> None:
    body = Body(Actor(lengths))
    scale = leg_length_m(body.actor) / leg_length_m(ACTOR)
    posture = grounded(2, height_m)
    fitted = transferred(posture, ACTOR, body)
    assert sole_heights_m(body, body.pose(fitted)).min() == pytest.approx(scale * height_m, abs=1e-12)
    np.testing.assert_array_equal(fitted.rotations, posture.rotations)
    np.testing.assert_allclose(fitted.translation[:2], scale * posture.translation[:2])


def test_a_child_does_what_an_adult_does() -> None:
    child = Body(Actor({name: 0.7 * length for name, length in LENGTHS.items()}))
    batch = Posture.stack([grounded(seed, 0.05 * seed) for seed in range(4)])
    small = transferred(batch, ACTOR, child)
    np.testing.assert_allclose(child.points(child.pose(small)), 0.7 * OWN.points(OWN.pose(batch)), atol=1e-12)
    back = transferred(small, child.actor, OWN)
    np.testing.assert_allclose(back.translation, batch.translation, atol=1e-12)
