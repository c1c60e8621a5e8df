"""The plan of a character for tests, and its bones as they are made."""

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
