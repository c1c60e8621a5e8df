"""Keyframes that a person posed, and which found ones are posed anew around a corrected one."""

from dataclasses import replace
from pathlib import Path
from typing import cast

import numpy as np
import pytest
from _synthetic_take import true_postures, write_synthetic_take
from keymark.core.body.actor import Actor
from keymark.core.body.kinematics import Body
from keymark.core.body.posture import Posture
from keymark.core.poses.clip_input import PosedFrames, Section, section_around, take_around
from keymark.core.prior.keyframes import Keyframe, Matched
from keymark.core.prior.library import read_library
from keymark.core.prior.registry import SHIPPED
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take

FRAMES = 100
TIME_S = np.arange(FRAMES) / 25.0
TRUTH = true_postures(1)
FOUND = Matched("composed", "Sway", False, 0.5)


def keyframes(posed: list[int], found: list[int]) -> list[Keyframe]:
    return [
        *(Keyframe(index, TRUTH[0]) for index in posed),
        *(Keyframe(index, TRUTH[0], matched=FOUND) for index in found),
    ]


@pytest.mark.parametrize(
    ("posed", "found", "section"),
    [
        ([20, 40, 60], [30, 35, 45], Section(20, 60, (30, 35, 45))),  # up to decided ones
        ([40], [10, 20, 50], Section(10, 99, (20, 50))),  # beyond half a second a found one bounds it
        ([40], [5, 90], Section(0, 99, (5, 90))),  # but always beyond one
        ([40], [50], Section(40, 99, (50,))),  # nowhere without one
        ([40], [], Section(40, 40, ())),
    ],
)
def test_a_section_ends_where_keyframes_hold(posed: list[int], found: list[int], section: Section) -> None:
    assert section_around(TIME_S, 40, keyframes(posed, found)) == section


def test_what_bounds_a_section_holds_like_a_posed_keyframe(tmp_path_factory: pytest.TempPathFactory) -> None:
    folder = cast(Path, tmp_path_factory.mktemp("takes")) / "take"
    take: Take = read_take(write_synthetic_take(folder, 24))
    mixed = sorted(keyframes([12], [2, 6, 16, 22]), key=lambda each: each.index)
    held = take_around(replace(take, keyframes=tuple(mixed)), Section(2, 23, (6, 16, 22))).keyframes
    assert [(each.index, each.matched) for each in held] == [(2, None), (12, None)]
    assert [each.depth_found for each in held] == [True, False]


BODY = Body(Actor.from_stature(1.7))


def test_only_what_a_person_posed_counts_as_posed() -> None:
    library = read_library(SHIPPED / "squatting_lifting.json")
    low, other = (each.posture for each in library.postures[:2])
    raised = Posture(low.skeleton, low.translation + np.array([0.0, 0.0, 0.4]), low.rotations, low.angles)
    said = Matched("squatting_lifting", library.postures[1].name, False, 0.9)
    posed = PosedFrames.of(BODY, [Keyframe(9, raised), Keyframe(5, other, matched=said), Keyframe(2, raised)])
    assert posed.frames.tolist() == [2, 9]
    assert np.array_equal(posed.hips[1], raised.translation)
    lowest = PosedFrames.of(BODY, [Keyframe(0, low)]).floor_m()
    assert lowest is not None
    assert posed.floor_m() == pytest.approx(lowest + 0.4)
    assert PosedFrames.of(BODY, []).floor_m() is None
    assert PosedFrames.of(BODY, [Keyframe(0, low, depth_found=True)]).floor_m() is None
