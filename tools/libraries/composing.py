"""Composition of a library: moments get names and times, and become postures in a file's precision."""

from collections.abc import Callable, Sequence

import numpy as np
from keymark.core.body.posture import Posture
from keymark.core.prior.library import Library, LibraryMotion, LibraryPosture, MotionStep, Travel

from .moment import Moment
from .solving import BODY, posture_of

AUTHOR, LICENSE = "Keymark", "CC0-1.0"
DECIMALS = 4
"""Decimals of meters and radians: a tenth of a millimeter, and equal on every computer."""


class Composer:
    """Collects a library's postures and motions."""

    def __init__(
        self,
        identifier: str,
        title: str,
        description: str,
        sources: Sequence[str],
        tags: Sequence[str] = (),
        version: int = 1,
    ) -> None:
        self._about = {
            "identifier": identifier,
            "title": title,
            "version": version,
            "author": AUTHOR,
            "license": LICENSE,
            "description": description,
            "sources": tuple(sources),
            "tags": tuple(tags),
        }
        self._postures: dict[str, LibraryPosture] = {}
        self._motions: list[LibraryMotion] = []

    def pose(self, name: str, moment: Moment, *tags: str) -> str:
        """Add a posture and return its name.

        Raises:
            ValueError: The name is taken, or a limb cannot reach its target.
        """
        if name in self._postures:
            raise ValueError(f"there are two postures called {name}")
        try:
            posture = posture_of(moment)
        except ValueError as error:
            raise ValueError(f"{name}: {error}") from error
        vector = np.round(posture.to_vector(), DECIMALS) + 0.0
        self._postures[name] = LibraryPosture(name, Posture.from_vector(BODY.skeleton, vector), tags)
        return name

    def motion(
        self,
        name: str,
        steps: Sequence[tuple[str, float]],
        duration_s: float | None = None,
        cyclic: bool = False,
        travel: Travel = (0.0, 0.0, 0.0),
    ) -> None:
        """Add a motion through postures (name, time [s]); by default it ends with its last step."""
        times = [round(time_s, 3) for _, time_s in steps]
        self._motions.append(
            LibraryMotion(
                name,
                tuple(MotionStep(posture, time_s) for (posture, _), time_s in zip(steps, times, strict=True)),
                round(times[-1] if duration_s is None else duration_s, 3),
                cyclic,
                (round(travel[0], DECIMALS), round(travel[1], DECIMALS), round(travel[2], DECIMALS)),
            )
        )

    def cycle(
        self,
        name: str,
        at: Callable[[float], Moment],
        phases: Sequence[tuple[str, float]],
        duration_s: float,
        travel: Travel = (0.0, 0.0, 0.0),
        tags: Sequence[str] = (),
    ) -> None:
        """Add a cyclic motion.

        Args:
            name: Name of the motion; its postures are named after it and their phase.
            at: The moment at a phase from 0 to 1.
            phases: Names of phases, and where in the cycle they are; the first is at 0.
            duration_s: Duration of a cycle.
            travel: Change of position [m] and heading [rad] over a cycle.
            tags: Tags of the postures.
        """
        steps = [
            (self.pose(f"{name}: {phase}", at(share), *tags), share * duration_s) for phase, share in phases
        ]
        self.motion(name, steps, duration_s, True, travel)

    def library(self) -> Library:
        """The library of the collected postures and motions."""
        return Library(
            actor=BODY.actor,
            postures=tuple(self._postures.values()),
            motions=tuple(self._motions),
            **self._about,  # type: ignore[arg-type]
        )
