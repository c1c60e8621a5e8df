"""Jogging, running, jogging on a belt and on the spot."""

from keymark.core.prior.library import Library

from ..composing import Composer
from ..moment import Moment
from ..placing import moved
from ..run import Pace, Run

Phases = tuple[tuple[str, float], ...]

PHASES = (
    ("left foot lands", 0.0),
    ("left knee bends", 0.10),
    ("left bears", 0.20),
    ("left heel off", 0.29),
    ("left toe off", 0.38),
    ("flight to the right", 0.44),
    ("right foot lands", 0.5),
    ("right knee bends", 0.60),
    ("right bears", 0.70),
    ("right heel off", 0.79),
    ("right toe off", 0.88),
    ("flight to the left", 0.94),
)
FEWER_PHASES = (
    ("left foot lands", 0.0),
    ("left bears", 0.15),
    ("left heel off", 0.28),
    ("left toe off", 0.39),
    ("right foot lands", 0.5),
    ("right bears", 0.65),
    ("right heel off", 0.78),
    ("right toe off", 0.89),
)
SOURCES = (
    "Novacheck, T. F. (1998). The biomechanics of running. Gait & Posture 7, 77-95.",
    "Hinrichs, R. N. (1987). Upper extremity function in running. II: angular momentum considerations."
    " International Journal of Sport Biomechanics 3, 242-263.",
)
JOG = Pace(
    stride_m=1.95,
    stride_s=0.74,
    stance=0.38,
    ahead_m=0.24,
    hip={0.0: -4.0, 0.1: -5.0, 0.35: 22.0, 0.6: 41.0, 0.78: 44.0, 1.0: 33.0},
    knee={0.0: 24.0, 0.15: 50.0, 0.42: 92.0, 0.6: 84.0, 0.82: 36.0, 1.0: 17.0},
    landing_deg=17.0,
    bow=9.0,
    arms=26.0,
)
PACES = {
    "jog": JOG,
    "run": Pace(
        stride_m=2.6,
        stride_s=0.68,
        stance=0.31,
        ahead_m=0.30,
        hip={0.0: -7.0, 0.1: -7.0, 0.35: 27.0, 0.6: 54.0, 0.75: 57.0, 1.0: 38.0},
        knee={0.0: 24.0, 0.15: 56.0, 0.42: 112.0, 0.6: 98.0, 0.82: 40.0, 1.0: 17.0},
        landing_deg=17.0,
        bow=12.0,
        arms=36.0,
        elbow=92.0,
    ),
    "jog on the spot": Pace(
        stride_m=0.0,
        stride_s=0.68,
        stance=0.40,
        ahead_m=0.03,
        hip={0.0: 8.0, 0.2: 16.0, 0.5: 38.0, 0.8: 22.0, 1.0: 10.0},
        knee={0.0: 22.0, 0.2: 52.0, 0.5: 92.0, 0.8: 44.0, 1.0: 18.0},
        landing_deg=26.0,
        bow=6.0,
        arms=20.0,
        push_deg=38.0,
        toes_up=-9.0,
        apart_m=0.06,
    ),
}


def library() -> Library:
    """Compose the library."""
    made = Composer(
        "running",
        "Running",
        "Jogging, running, jogging on a treadmill, and jogging on the spot.",
        SOURCES,
        ("running", "jogging"),
    )
    for name, pace in PACES.items():
        phases = PHASES if pace.stride_m > 0.0 else FEWER_PHASES
        made.cycle(name, Run(pace).at, _moved(phases, pace), pace.stride_s, (0.0, -pace.stride_m, 0.0))
    made.cycle("jog on a treadmill", _on_a_belt, _moved(FEWER_PHASES, JOG), JOG.stride_s)
    return made.library()


def _on_a_belt(phase: float) -> Moment:
    """Jogging on a belt that takes back what the jogger gains."""
    return moved(Run(JOG).at(phase), y=phase * JOG.stride_m)


def _moved(phases: Phases, pace: Pace) -> list[tuple[str, float]]:
    """The phases of a runner whose feet bear for 0.38 of the cycle, for one with another stance."""
    shares = []
    for name, share in phases:
        half, within = divmod(share, 0.5)
        if within <= 0.38:
            at = within * pace.stance / 0.38
        else:
            at = pace.stance + (within - 0.38) * (0.5 - pace.stance) / 0.12
        shares.append((name, 0.5 * half + at))
    return shares
