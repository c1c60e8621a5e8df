"""The plan of a character for tests, its bones as they are made, and what it wears."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from keymark.core.arrays import Array

SIDES = {"L": 1.0, "R": -1.0}


@dataclass
class Plan:
    """What a body is made of; lengths are shares of its height."""

    height: float = 1.72
    leg: float = 0.52
    """Height of the hip joints."""
    trunk: float = 0.29
    """From hip to shoulder joints."""
    arm: float = 0.3
    """Upper arm and forearm."""
    head: float = 0.13
    """From the head joint to the top."""
    neck: float = 0.06
    shoulder_width: float = 0.1
    """From the middle to an upper arm."""
    hip_width: float = 0.053
    foot: float = 0.09
    """From ankle to toe, forward."""
    ankle: float = 0.045
    knee: float = 0.5
    elbow: float = 0.52
    arms_down_deg: float = 0.0
    elbow_bend_deg: float = 5.0
    knee_bend_deg: float = 4.0
    legs_apart_deg: float = 2.0
    spines: int = 3
    necks: int = 1
    shoulders: bool = True
    toes: bool = True
    hands: bool = True
    fingers: int = 5
    finger_bones: int = 3
    head_end: bool = False
    toe_end: bool = False
    root: str | None = None
    """`ground`, `center` or None."""
    twists: str | None = None
    """`beside`, `inside` or None."""
    feet_on: str = "shin"
    """`shin`, or `root`: feet hang on the root as controls."""
    clavicles_on_neck: bool = False
    thigh_holders: bool = False
    """Bones from the hips to the thighs, as LHipJoint and pelvis.L."""
    worn: tuple[str, ...] = ()
    tails: str = "good"
    """`good`, `aside`: all along one axis, or `far`."""
    noise: float = 0.0
    """Deviation of every joint [m]."""
    yaw_deg: float = 0.0
    y_up: bool = False
    scale: float = 1.0
    shuffled: bool = False
    names: Mapping[str, str] = field(default_factory=dict)


class Builder:
    """Bones in meters, Z up, facing -Y, with the parts that they play."""

    def __init__(self) -> None:
        self.names: list[str] = []
        self.parents: list[int] = []
        self.heads: list[Array] = []
        self.tails: list[Array] = []

    def add(self, name: str, parent: str | None, head: Array, tail: Array) -> str:
        """Add a bone; its name."""
        self.names.append(name)
        self.parents.append(self.names.index(parent) if parent is not None else -1)
        self.heads.append(np.array(head, dtype=np.float64))
        self.tails.append(np.array(tail, dtype=np.float64))
        return name

    def chain(self, name: str, parent: str, points: Array, count_from: int = 1) -> list[str]:
        """A chain of bones through points."""
        found = []
        for number, (head, tail) in enumerate(zip(points[:-1], points[1:], strict=True), count_from):
            found.append(self.add(f"{name}_{number}", found[-1] if found else parent, head, tail))
        return found


# --- Things that characters for tests wear: bones beside the body that play no role


Truth = Mapping[str, tuple[str, ...]]


def _hair(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    """Strands at the back and both sides, from the head down."""
    H, count = plan.height, int(rng.integers(2, 6))
    top = made.heads[made.names.index("head")] + [0.0, 0.03 * H, 0.6 * plan.head * H]
    reach = rng.uniform(0.1, 0.9) * top[2]
    for name, x in (("hair_back", 0.0), ("hair.L", 0.06), ("hair.R", -0.06)):
        steps = np.linspace(0.0, 1.0, count + 1)[:, None]
        made.chain(name, "head", top + [x * H, 0.03 * H, 0.0] + steps * np.array([x * H, 0.05 * H, -reach]))


def _bun(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    """A hat or a bun above the head."""
    top = made.heads[made.names.index("head")] + [0.0, 0.0, plan.head * plan.height]
    made.chain("bun", "head", top + np.linspace(0, 1, 3)[:, None] * [0.0, 0.02, 0.12 * plan.height])


def _skirt_of(made: Builder, plan: Plan, rng: np.random.Generator, reach: float) -> None:
    H, count, strands = plan.height, int(rng.integers(2, 6)), int(rng.choice([4, 6, 8]))
    waist = made.heads[made.names.index("hips")]
    for strand in range(strands):
        angle = 2.0 * np.pi * (strand + 0.5) / strands
        out = np.array([np.sin(angle), -np.cos(angle), 0.0])
        steps = np.linspace(0.0, 1.0, count + 1)[:, None]
        points = waist + out * 0.07 * H + steps * (out * 0.05 * H - [0.0, 0.0, reach])
        made.chain(f"skirt{strand}", "hips", points)


def _skirt(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    _skirt_of(made, plan, rng, 0.4 * plan.leg * plan.height)


def _long_skirt(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    _skirt_of(made, plan, rng, 0.95 * plan.leg * plan.height)


def _tail(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H, count = plan.height, int(rng.integers(3, 8))
    start = made.heads[made.names.index("hips")] + [0.0, 0.05 * H, 0.0]
    steps = np.linspace(0.0, 1.0, count + 1)[:, None]
    made.chain("tail", "hips", start + steps * [0.0, 0.35 * H, -0.3 * H])


def _wings(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H, count = plan.height, int(rng.integers(2, 5))
    span, rise = rng.uniform(0.3, 0.8), rng.uniform(-0.1, 0.4)
    start = np.array([0.04, 0.06, plan.leg + 0.9 * plan.trunk]) * H
    for side, sign in SIDES.items():
        steps = np.linspace(0.0, 1.0, count + 1)[:, None]
        points = start + steps * np.array([span, 0.15, rise]) * H
        bones = made.chain(f"wing.{side}", truth["spine"][-1], points * [sign, 1.0, 1.0])
        for feather in range(int(rng.integers(0, 4))):
            tip = (points[-2] + np.array([0.1 * feather, 0.05, -0.3]) * H) * [sign, 1.0, 1.0]
            made.add(f"feather{feather}.{side}", bones[-1], points[-2] * [sign, 1.0, 1.0], tip)


def _weapon(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H = plan.height
    hand = truth.get("hand.R", truth["forearm.R"])[0]
    start = made.tails[made.names.index(hand)]
    made.chain("sword", hand, start + np.linspace(0, 1, 3)[:, None] * np.array([0.0, -0.5, 0.1]) * H)


def _breasts(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H = plan.height
    for side, sign in SIDES.items():
        start = np.array([sign * 0.03, -0.03, plan.leg + 0.75 * plan.trunk]) * H
        made.chain(
            f"breast.{side}",
            truth["spine"][-1],
            start + np.linspace(0, 1, 3)[:, None] * np.array([sign * 0.02, -0.05, 0.0]) * H,
        )


def _face(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H = plan.height
    skull = made.heads[made.names.index("head")]
    made.add("jaw", "head", skull + np.array([0.0, -0.01, 0.01]) * H, skull + np.array([0.0, -0.05, 0.0]) * H)
    for side, sign in SIDES.items():
        for name, x, z in (("eye", 0.018, 0.4), ("brow", 0.02, 0.5), ("cheek", 0.025, 0.25)):
            start = skull + [sign * x * H, -0.045 * H, z * plan.head * H]
            made.add(f"{name}.{side}", "head", start, start + [0.0, -0.02 * H, 0.0])


def _cape(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H, count = plan.height, int(rng.integers(3, 7))
    start = np.array([0.0, 0.06, plan.leg + plan.trunk]) * H
    for name, x in (("cape", 0.0), ("cape.L", 0.07), ("cape.R", -0.07)):
        steps = np.linspace(0.0, 1.0, count + 1)[:, None]
        made.chain(name, truth["spine"][-1], start + [x * H, 0, 0] + steps * np.array([x, 0.05, -0.6]) * H)


def _pouch(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    H = plan.height
    start = np.array([0.09, 0.0, plan.leg]) * H
    made.add("pouch", "hips", start, start - [0.0, 0.0, 0.08 * H])


def _ears(made: Builder, plan: Plan, truth: Truth, rng: np.random.Generator) -> None:
    """Long ears on top of the head."""
    H = plan.height
    for side, sign in SIDES.items():
        start = made.heads[made.names.index("head")] + [sign * 0.03 * H, 0.0, 0.9 * plan.head * H]
        made.chain(
            f"ear.{side}",
            "head",
            start + np.linspace(0, 1, 4)[:, None] * np.array([sign * 0.04, 0.02, 0.15]) * H,
        )


WORN = {
    "hair": _hair,
    "bun": _bun,
    "skirt": _skirt,
    "long_skirt": _long_skirt,
    "tail": _tail,
    "wings": _wings,
    "weapon": _weapon,
    "breasts": _breasts,
    "face": _face,
    "cape": _cape,
    "pouch": _pouch,
    "ears": _ears,
}
