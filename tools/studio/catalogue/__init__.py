"""All takes: the demonstration, and others that share as little as possible with it."""

from .dances import BACK_SPIN, DANCE, FURNITURE, SPIN
from .demonstration import DEMONSTRATION
from .exercises import JOG, JUMP, LIFT, STAR_JUMPS
from .fights import BOX, KICK, MARTIAL, SPIN_KICK
from .throws import THROW, THROW60
from .visits import GREETING
from .walks import APPROACH, DUCK, FAR_LEG, STEPS, STROLL

TAKES = {
    described.name: described
    for described in (
        DEMONSTRATION, JOG, KICK, BOX, JUMP, SPIN, LIFT, DANCE, STROLL, THROW, STAR_JUMPS,
        SPIN_KICK, FURNITURE, FAR_LEG, MARTIAL, APPROACH, BACK_SPIN, STEPS, DUCK, THROW60, GREETING,
    )
}  # fmt: skip
