"""Walking at three speeds and with quiet arms, starting and stopping."""

from keymark.core.library.library import Library

from ..composing import Composer
from ..gait import Style, Walk, steady
from ..moment import Moment

PHASES = (
    ("left heel strike", 0.0),
    ("right toe off", 0.11),
    ("right leg swings", 0.21),
    ("feet pass, left stands", 0.31),
    ("left heel off", 0.41),
    ("right heel strike", 0.5),
    ("left toe off", 0.61),
    ("left leg swings", 0.71),
    ("feet pass, right stands", 0.81),
    ("right heel off", 0.91),
)
SOURCES = (
    "Perry, J. & Burnfield, J. M. (2010). Gait Analysis: Normal and Pathological Function, 2nd ed.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
    "Kadaba, M. P., Ramakrishnan, H. K. & Wootten, M. E. (1990). Measurement of lower extremity kinematics"
    " during level walking. Journal of Orthopaedic Research 8.",
    "Murray, M. P., Drought, A. B. & Kory, R. C. (1964). Walking patterns of normal men. Journal of Bone and"
    " Joint Surgery 46-A.",
    "Murray, M. P., Sepic, S. B. & Barnard, E. J. (1967). Patterns of sagittal rotation of the upper limbs in"
    " walking. Physical Therapy 47.",
)
USUAL = Style()
GAITS = {
    "walk": (1.42, 1.08, USUAL),
    "slow walk": (1.06, 1.28, Style(elbow=10.0)),
    "brisk walk": (1.72, 0.94, Style(elbow=20.0, bow=3.0)),
}
"""Stride [m], its time [s], and how."""


def library() -> Library:
    """Compose it."""
    made = Composer(
        "walking",
        "Walking",
        "Walking straight ahead: slowly, as usual and briskly.",
        SOURCES,
        ("walking", "gait"),
    )
    for name, (stride_m, stride_s, style) in GAITS.items():
        walk = steady(stride_m, stride_s, style)

        def at(phase: float, walk: Walk = walk, stride_s: float = stride_s) -> Moment:
            return walk.at(phase * stride_s)

        made.cycle(name, at, PHASES, stride_s, (0.0, -stride_m, 0.0))
    return made.library()
