"""All takes: the demonstration, and others that share as little as possible with it."""

from .dances import BACK_SPIN, DANCE, SPIN
from .demonstration import DEMONSTRATION
from .exercises import JOG, JUMP, LIFT, STAR_JUMPS
from .fights import BOX, KICK, MARTIAL
from .throws import THROW, THROW60
from .visits import GREETING
from .walks import APPROACH, DUCK, STEPS, STROLL

TAKES = {
    described.name: described
    for described in (
        DEMONSTRATION, JOG, KICK, BOX, JUMP, SPIN, LIFT, DANCE, STROLL, THROW, STAR_JUMPS,
        MARTIAL, APPROACH, BACK_SPIN, STEPS, DUCK, THROW60, GREETING,
    )
}  # fmt: skip
