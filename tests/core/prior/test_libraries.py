"""Libraries: found by name, merged, transferred to other proportions, and seen in a mirror."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from _fuzz import libraries
from _libraries import ACTOR, random_posture, small_library
from hypothesis import HealthCheck, given, settings
from keymark.core.body.actor import Actor
from keymark.core.body.body_volume import sole_heights_m
from keymark.core.body.human import HUMAN
from keymark.core.body.kinematics import Body
from keymark.core.body.mirror import MIRROR, mirrored
from keymark.core.body.posture import Posture
from keymark.core.errors import InputError
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep, write_library
from keymark.core.prior.merging import differing_names, join_libraries, merge_versions
from keymark.core.prior.motion_playback import sample_motion
from keymark.core.prior.registry import find_library, identifier_of, library_path, registered_libraries
from keymark.core.prior.transfer import leg_length_m, mirrored_library, mirrored_name, transferred

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


MINE = small_library()
NEW = LibraryPosture("Jump", random_posture(9))
OTHER_LANDING = LibraryPosture("LEFT foot lands", random_posture(8))


def newer(**changes: object) -> Library:
    return replace(MINE, version=4, **changes)


THEIRS = newer(
    title="Steps",
    postures=(NEW, OTHER_LANDING, *MINE.postures[1:]),
    motions=(LibraryMotion("Leap", (MotionStep("LEFT foot lands", 0.0), MotionStep("Jump", 0.4)), 0.6),),
)


def names(library: Library) -> list[str]:
    return [posture.name for posture in library.postures]


def test_what_differs_is_named() -> None:
    assert differing_names(MINE, THEIRS) == ("Left foot lands",)
    assert differing_names(MINE, newer(title="Other")) == ()


def test_different_libraries_never_touch() -> None:
    with pytest.raises(InputError, match="'small_steps' and 'walking' have different identifiers"):
        differing_names(MINE, replace(MINE, identifier="walking"))


@pytest.mark.parametrize("replaces", [False, True])
def test_merging_adds_what_is_new_and_replaces_the_rest_if_told(replaces: bool) -> None:
    result = merge_versions(MINE, THEIRS, replaces)
    landing = "LEFT foot lands" if replaces else "Left foot lands"
    assert names(result) == [landing, *names(MINE)[1:], "Jump"]
    kept = (OTHER_LANDING if replaces else MINE.postures[0]).posture
    assert np.abs(result.postures[0].posture.minus(kept)).max() == 0.0
    assert [motion.name for motion in result.motions] == ["Steps", "Once", "Leap"]
    assert {motion.steps[0].posture for motion in result.motions} == {landing}
    assert (result.version, result.title) == (5, "Steps")
    Library.from_json(result.to_json(), "here")


def test_postures_of_another_actor_are_fitted() -> None:
    taller = Actor({name: 1.2 * length for name, length in ACTOR.segments_m.items()})
    result = merge_versions(MINE, newer(actor=taller, postures=(NEW,), motions=()), False)
    assert result.actor is MINE.actor
    np.testing.assert_allclose(
        result.by_name["Jump"].posture.translation, NEW.posture.translation / 1.2, atol=1e-9
    )


def test_two_libraries_become_a_third() -> None:
    other = replace(
        THEIRS, identifier="other", license="CC-BY-4.0 OR MIT", author="B. Person", sources=("Another.",)
    )
    both = join_libraries(MINE, other, "both", "Both of them")
    assert names(both) == [*names(MINE), "Jump", "LEFT foot lands 2"]
    assert [motion.name for motion in both.motions] == ["Steps", "Once", "Leap"]
    assert [step.posture for step in both.motions[2].steps] == ["LEFT foot lands 2", "Jump"]
    assert (both.identifier, both.version, both.author) == ("both", 1, "A. Person, B. Person")
    assert both.license == "CC0-1.0 AND (CC-BY-4.0 OR MIT)"
    assert both.sources == (*MINE.sources, "Another.")
    Library.from_json(both.to_json(), "here")
    with pytest.raises(InputError, match="identifier"):
        join_libraries(MINE, other, "../both", "Both")


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


@pytest.mark.parametrize(
    ("name", "other"),
    [
        ("Left foot lands", "Right foot lands"),
        ("turn right, LEFT foot", "turn left, RIGHT foot"),
        ("kick_left", "kick_right"),
        ("Hook.L", "Hook.R"),
        ("Step L to R", "Step R to L"),
        ("Upright, leftover Lunge", "Upright, leftover Lunge"),
    ],
)
def test_sides_in_names_are_exchanged(name: str, other: str) -> None:
    assert mirrored_name(name) == other
    assert mirrored_name(other) == name


@settings(max_examples=40, suppress_health_check=[HealthCheck.too_slow])
@given(libraries())
def test_any_library_can_be_mirrored_and_back(library: Library) -> None:
    library = Library.from_json(library.to_json(), "here")
    written = mirrored_library(library).to_json()
    assert Library.from_json(written, "here").to_json() == written


def test_a_mirrored_motion_runs_as_in_a_mirror() -> None:
    times = np.linspace(0.0, 3.7, 30)
    body = Body(ACTOR)
    there = sample_motion(LIBRARY, LIBRARY.motions[0], body, times)
    other = mirrored_library(LIBRARY)
    here = sample_motion(other, other.motions[0], body, times)
    np.testing.assert_allclose(here.minus(mirrored(there)), 0.0, atol=1e-9)
    assert (there.translation * MIRROR)[-1] == pytest.approx(here.translation[-1])
