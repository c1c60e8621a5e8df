"""All takes: the demonstration, and others that share as little as possible with it."""

from .dances import DANCE, FURNITURE, SPIN
from .demonstration import DEMONSTRATION
from .exercises import JOG, JUMP, LIFT, STAR_JUMPS
from .fights import BOX, KICK, MARTIAL, SPIN_KICK
from .throws import THROW
from .walks import FAR_LEG, STROLL

TAKES = {
    described.name: described
    for described in (
        DEMONSTRATION, JOG, KICK, BOX, JUMP, SPIN, LIFT, DANCE, STROLL, THROW, STAR_JUMPS,
        SPIN_KICK, FURNITURE, FAR_LEG, MARTIAL,
    )
}  # fmt: skip
