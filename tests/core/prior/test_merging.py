"""Two libraries of one name, and two that become one."""

from dataclasses import replace

import numpy as np
import pytest
from _libraries import ACTOR, random_posture, small_library
from keymark.core.body.actor import Actor
from keymark.core.errors import InputError
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep
from keymark.core.prior.merging import differing_names, join_libraries, merge_versions

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
    stranger = replace(MINE, identifier="walking")
    for act in (differing_names, merge_versions):
        with pytest.raises(InputError, match="'small_steps' and 'walking' have different identifiers"):
            act(MINE, stranger)


@pytest.mark.parametrize("replaces", [False, True])
def test_merging_adds_what_is_new_and_asks_for_the_rest(replaces: bool) -> None:
    with pytest.raises(InputError, match="'Left foot lands' differ"):
        merge_versions(MINE, THEIRS)
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
