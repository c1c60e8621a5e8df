"""Few keys hold the character: its points, its resting feet, and IK and FK together."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from _characters import plain_character, plain_map
from _controls import control_motion, quaternion_values, with_ik
from _performances import performance, stepping
from keymark.core.body.kinematics import SegmentMotion
from keymark.core.keys.hermite import Spline
from keymark.core.keys.rig import rotation_matrices
from keymark.core.progress import run
from keymark.core.retarget.character import Similarity
from keymark.core.retarget.character_motion import CharacterMotion
from keymark.core.retarget.controls.control_channels import (
    NOTHING,
    Control,
    ControlChannels,
    ControlKind,
    ControlSpace,
    PlannedControl,
    control_channels,
    ordered_controls,
)
from keymark.core.retarget.controls.control_motion import ControlMotion, KeyedControl, dense_controls
from keymark.core.retarget.controls.point_tolerances import ToleranceRules
from keymark.core.retarget.controls.reduction import reduce_controls
from keymark.core.retarget.solve.solve_motion import solve_motion
from keymark.core.take.conversion_settings import LimbKeys, RetargetOptions

FRAMES = 60
TIMES = 1.0 + np.arange(FRAMES)
UP = np.array([0.0, 0.0, 1.0])
HERE = Similarity(np.eye(3), np.zeros(3), 1.0)


@cache
def source() -> SegmentMotion:
    """The demonstration's first steps."""
    body, posture = stepping()
    return performance(body, posture[:FRAMES])


@cache
def solved() -> CharacterMotion:
    """The steps on a plain character."""
    character = plain_character()
    return run(solve_motion(character, plain_map(character), source(), RetargetOptions(), HERE))


def on_controls(keys: LimbKeys) -> ControlMotion:
    """The steps on a plain character's bones, goals and poles."""
    character = plain_character()
    options = RetargetOptions(arms=keys, legs=keys)
    return control_motion(character, with_ik(plain_map(character)), solved(), options)


def reduced(motion: ControlMotion, tolerance_m: float = 0.005) -> tuple[KeyedControl, ...]:
    """Few keys."""
    rules = ToleranceRules(solved(), source().time_s, UP, tolerance_m)
    return run(reduce_controls(motion, TIMES, rules, quaternion_values))


def shown(motion: ControlMotion, keyed: tuple[KeyedControl, ...]) -> dict[str, ControlChannels]:
    """What controls show by their keys."""
    found: list[ControlChannels] = []
    for control, one in zip(motion.controls, keyed, strict=True):
        space = control.space
        carrier = found[space.carrier] if space.carrier != NOTHING else None
        turner = found[space.turner] if space.turner != NOTHING else None
        place = np.broadcast_to(space.origin, (FRAMES, 3))
        turn = np.broadcast_to(space.turn, (FRAMES, 3, 3))
        if one.location is not None:
            place = place + values(one.location) @ space.axes.T
        if one.rotation is not None:
            turn = turn @ rotation_matrices(values(one.rotation), control.mode)
        if carrier is not None:
            place = carrier.place + (carrier.turn @ place[..., None])[..., 0]
        if turner is not None:
            turn = turner.turn @ turn
        found.append(ControlChannels(None, None, turn, place))
    return {control.name: channels for control, channels in zip(motion.controls, found, strict=True)}


def values(held: np.ndarray | Spline) -> np.ndarray:
    """(F, C) values of keys."""
    return held.evaluate(TIMES, 0, FRAMES - 1) if isinstance(held, Spline) else held


def key_count(keyed: tuple[KeyedControl, ...]) -> int:
    """Number of keys."""
    return sum(held.size for one in keyed for held in one.values)


def off_m(motion: ControlMotion, poses: dict[str, ControlChannels], name: str) -> np.ndarray:
    """(F,) distance of a control from where it is to be."""
    return np.linalg.norm(poses[name].place - motion.wanted[name][:, :3, 3], axis=-1)


@pytest.mark.parametrize("keys", list(LimbKeys))
def test_every_joint_stays_within_the_tolerance(keys: LimbKeys) -> None:
    motion = on_controls(keys)
    keyed = reduced(motion)
    poses = shown(motion, keyed)
    for control in motion.controls:
        if control.plan.kind is not ControlKind.POLE:
            assert off_m(motion, poses, control.name).max() < 0.0051
    dense = dense_controls(motion, quaternion_values)
    assert key_count(keyed) < 0.33 * key_count(dense)


def test_dense_keys_are_the_motion_itself() -> None:
    motion = on_controls(LimbKeys.BOTH)
    poses = shown(motion, dense_controls(motion, quaternion_values))
    assert max(off_m(motion, poses, control.name).max() for control in motion.controls) < 1e-9


def test_resting_feet_do_not_slide() -> None:
    rests = [rest for rest in solved().rests if rest.last - rest.first > 5]
    assert rests
    for keys, foot in ((LimbKeys.FK, "foot"), (LimbKeys.BOTH, "ik_foot")):
        motion = on_controls(keys)
        poses = shown(motion, reduced(motion))
        for rest in rests:
            path = poses[f"{foot}.{rest.leg[-1]}"].place[rest.first : rest.last + 1]
            assert np.linalg.norm(path - path.mean(axis=0), axis=-1).max() < 0.0003
            assert np.linalg.norm(np.diff(path, axis=0), axis=-1).mean() < 0.0001


def test_switching_between_ik_and_fk_moves_nothing() -> None:
    motion = on_controls(LimbKeys.BOTH)
    poses = shown(motion, reduced(motion))
    for side in "LR":
        for end in ("hand", "foot"):
            apart = poses[f"ik_{end}.{side}"].place - poses[f"{end}.{side}"].place
            assert np.linalg.norm(apart, axis=-1).max() < 0.001


def test_a_tighter_tolerance_takes_more_keys() -> None:
    motion = on_controls(LimbKeys.FK)
    counts = [key_count(reduced(motion, mm / 1000.0)) for mm in (2, 5, 15)]
    assert counts[0] > counts[1] > counts[2]


def test_feet_on_a_root_are_placed_and_turned() -> None:
    def free(plan: PlannedControl, space: ControlSpace) -> ControlSpace:
        if not plan.name.startswith("foot"):
            return space
        rest = plain_character().bone(plan.name).rest
        return replace(
            space, turner=NOTHING, carrier=NOTHING, turn=rest[:3, :3], origin=rest[:3, 3], axes=rest[:3, :3]
        )

    character = plain_character()
    motion = control_motion(character, plain_map(character), solved(), RetargetOptions(), free)
    moved = {
        control.name
        for control, channels in zip(motion.controls, motion.channels, strict=True)
        if channels.location is not None
    }
    assert moved == {"hips", "foot.L", "foot.R"}
    poses = shown(motion, reduced(motion))
    assert max(off_m(motion, poses, name).max() for name in moved) < 0.0051


def control(
    name: str,
    turner: int,
    carrier: int,
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0),
    movable: bool = True,
    residual: float = 0.0,
) -> Control:
    """A control that turns, and moves where it can."""
    kind = ControlKind.HIPS if name == "hips" else ControlKind.FK
    axes = np.eye(3) if movable else np.zeros((3, 3))
    space = ControlSpace(turner, np.eye(3), carrier, np.array(origin), axes, 0.0, residual)
    return Control(PlannedControl(name, kind, name), "XYZ", space, turns=True)


def test_a_control_that_cannot_move_only_turns() -> None:
    controls = [
        control("hips", NOTHING, NOTHING, (1.0, 0.0, 0.0), movable=False),
        control("c", 0, 0, (0.0, 1.0, 0.0)),
    ]
    wanted = {name: np.tile(np.eye(4), (2, 1, 1)) for name in ("hips", "c")}
    wanted["hips"][:, :3, :3] = rotation_matrices(np.array([[0.0, 0.0, np.pi / 2]] * 2), "XYZ")
    wanted["c"][:, :3, 3] = [0.0, 0.0, 0.004]
    found = control_channels(controls, wanted, 0.5)
    assert found[0].location is None
    assert found[0].place == pytest.approx(np.array([[1.0, 0.0, 0.0]] * 2))
    assert found[1].location is not None
    assert found[1].place == pytest.approx(wanted["c"][:, :3, 3])
    wanted["c"][:, :3, 3] = [0.001, 0.0, 0.0]
    assert control_channels(controls, wanted, 0.5)[1].location is None


def test_controls_are_ordered_by_what_carries_them() -> None:
    ordered = ordered_controls([control("c", 1, 2), control("b", 2, 2), control("a", NOTHING, NOTHING)])
    assert [one.name for one in ordered] == ["a", "b", "c"]
    assert (ordered[2].space.turner, ordered[2].space.carrier) == (1, 0)
    circle = ordered_controls([control("a", 1, 1), control("b", 0, 0)])
    assert all(max(one.space.turner, one.space.carrier) < number for number, one in enumerate(circle))
    assert [one.space.residual < 1e-3 for one in circle] == [False, True]


def test_a_control_of_unknown_place_tears_nothing_off() -> None:
    adrift = control("b", NOTHING, NOTHING, movable=False, residual=np.inf)
    wanted = {name: np.tile(np.eye(4), (2, 1, 1)) for name in "bc"}
    wanted["b"][:, :3, 3] = [[3.0, 0.0, 0.0], [4.0, 0.0, 0.0]]
    wanted["c"][:, :3, 3] = [[3.0, 1.0, 0.0], [4.0, 1.0, 0.0]]
    found = control_channels([adrift, control("c", 0, 0, (0.0, 1.0, 0.0))], wanted, 1.0)
    assert found[0].location is None and found[1].location is None
    assert found[1].place == pytest.approx(wanted["c"][:, :3, 3])
