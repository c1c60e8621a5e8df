"""Kicks with the left leg: to the front, to the side, around, of a ball, and a straight swing of the leg."""

from dataclasses import replace

from keymark.core.prior.library import Library

from .. import easy_kicks
from ..balance import balanced
from ..composing import Composer
from ..kicker import BEHIND, GUARD, HANGING, LOW_GUARD, STAND, on_right
from ..moment import Arm, Foot, Leg, Moment, Turn, moment, swung_arm

SOURCES = (
    "Robertson, D. G. E. & Mosher, R. E. (1985). Work and power of the leg muscles in soccer kicking."
    " Biomechanics IX-B.",
    "Sørensen, H., Zacho, M., Simonsen, E. B., Dyhre-Poulsen, P. & Klausen, K. (1996). Dynamics of the"
    " martial arts high front kick. Journal of Sports Sciences 14.",
    "Wąsik, J. (2011). Kinematics and kinetics of taekwon-do side kick. Journal of Human Kinetics 30, 13-20.",
    "Kim, Y. K., Kim, Y. H. & Im, S. J. (2011). Inter-joint coordination in producing kicking velocity of"
    " taekwondo kicks. Journal of Sports Science and Medicine 10, 31-38.",
    "Kellis, E. & Katis, A. (2007). Biomechanical characteristics and determinants of instep soccer kick."
    " Journal of Sports Science and Medicine 6, 154-165.",
    "Winter, D. A. (2009). Biomechanics and Motor Control of Human Movement, 4th ed.",
)


def library() -> Library:
    """Compose the library."""
    made = Composer(
        "kicking",
        "Kicking",
        "Left kicks: front, side and around from a guard, front and side from standing, a ball with or"
        " without a run-up, a straight swing.",
        SOURCES,
        ("kicking", "martial arts", "football"),
    )
    guard = balanced(
        moment(
            left_leg=BEHIND,
            right_leg=STAND,
            arms=GUARD,
            bend=24.0,
            pelvis=Turn(4.0, 0.0, 16.0),
            waist=Turn(6.0, 0.0, -6.0),
            neck=Turn(-4.0, 0.0, -8.0),
        ),
        left=0.48,
    )
    made.pose("guard", guard)
    _front(made)
    _side(made)
    _around(made)
    _ball(made)
    _swing(made)
    easy_kicks.front(made)
    easy_kicks.side(made)
    return made.library()


def _front(made: Composer) -> None:
    open_arm = replace(GUARD, elevation=42.0, plane=30.0, elbow=92.0)
    moments = {
        "front: knee comes up": on_right(
            Leg(52.0, 4.0, 4.0, 104.0, 20.0), Turn(2.0, -2.0, 6.0), Turn(8.0), Turn(-4.0)
        ),
        "front: knee high": on_right(
            Leg(104.0, 6.0, 2.0, 122.0, 10.0),
            Turn(-9.0, -3.0, -10.0),
            Turn(10.0, 2.0, 6.0),
            Turn(2.0),
            bend=23.0,
        ),
        "front: leg snaps": on_right(
            Leg(104.0, 14.0, 2.0, 66.0, 15.0),
            Turn(-14.0, -4.0, -20.0),
            Turn(8.0, 3.0, 12.0),
            Turn(6.0, 0.0, 6.0),
            left_arm=open_arm,
            bend=19.0,
        ),
        "front: leg stretched": on_right(
            Leg(96.0, 18.0, 2.0, 10.0, 20.0),
            Turn(-18.0, -4.0, -26.0),
            Turn(6.0, 3.0, 16.0),
            Turn(8.0, 0.0, 8.0),
            left_arm=open_arm,
            bend=16.0,
        ),
        "front: leg drawn back": on_right(
            Leg(94.0, 8.0, 2.0, 104.0, 10.0),
            Turn(-8.0, -3.0, -14.0),
            Turn(10.0, 2.0, 8.0),
            Turn(2.0),
            bend=23.0,
        ),
        "front: leg goes down": on_right(
            Leg(36.0, 4.0, 8.0, 72.0, 10.0), Turn(2.0, -2.0, 4.0), Turn(8.0), Turn(-4.0), bend=23.0
        ),
    }
    _kick(made, "front kick", moments, (0.16, 0.32, 0.39, 0.45, 0.58, 0.78), 1.05)


def _side(made: Composer) -> None:
    out = replace(STAND, turn=-62.0)
    moments = {
        "side: knee comes up": on_right(
            Leg(56.0, 8.0, 0.0, 98.0, 10.0), Turn(2.0, -4.0, 2.0), Turn(6.0), stand=replace(STAND, turn=-34.0)
        ),
        "side: knee across": on_right(
            Leg(96.0, 14.0, -8.0, 124.0, -5.0),
            Turn(-2.0, -18.0, -18.0),
            Turn(4.0, 4.0, 14.0),
            Turn(0.0, 6.0, 22.0),
            stand=out,
            bend=20.0,
        ),
        "side: leg thrusts": on_right(
            Leg(58.0, 40.0, -16.0, 62.0, -5.0),
            Turn(4.0, -32.0, -26.0),
            Turn(2.0, 2.0, 16.0),
            Turn(0.0, 12.0, 42.0),
            stand=out,
            left_arm=replace(LOW_GUARD, elevation=34.0, plane=10.0),
            bend=20.0,
        ),
        "side: leg stretched": on_right(
            Leg(26.0, 58.0, -18.0, 8.0, -5.0),
            Turn(6.0, -38.0, -26.0),
            Turn(2.0, -2.0, 14.0),
            Turn(0.0, 16.0, 52.0),
            stand=out,
            left_arm=replace(LOW_GUARD, elevation=44.0, plane=0.0, elbow=48.0),
            bend=16.0,
        ),
        "side: leg drawn back": on_right(
            Leg(84.0, 26.0, -10.0, 116.0, -5.0),
            Turn(0.0, -24.0, -18.0),
            Turn(4.0, 4.0, 14.0),
            Turn(0.0, 8.0, 30.0),
            stand=out,
            bend=23.0,
        ),
        "side: leg goes down": on_right(
            Leg(42.0, 10.0, 4.0, 78.0, 5.0), Turn(2.0, -4.0, 4.0), Turn(6.0), stand=replace(STAND, turn=-34.0)
        ),
    }
    _kick(made, "side kick", moments, (0.18, 0.36, 0.45, 0.53, 0.70, 0.92), 1.20)


def _around(made: Composer) -> None:
    pivot = replace(STAND, turn=-72.0)
    low = replace(LOW_GUARD, elevation=38.0, plane=-10.0, elbow=46.0)
    moments = {
        "around: knee comes up outside": on_right(
            Leg(46.0, 28.0, 2.0, 106.0, 30.0),
            Turn(2.0, -10.0, -6.0),
            Turn(6.0, 4.0, 6.0),
            stand=replace(STAND, turn=-42.0),
        ),
        "around: hips turn": on_right(
            Leg(66.0, 44.0, -14.0, 118.0, 40.0),
            Turn(-2.0, -26.0, -48.0),
            Turn(4.0, 6.0, 22.0),
            Turn(0.0, 8.0, 22.0),
            stand=pivot,
            left_arm=replace(LOW_GUARD, plane=10.0),
        ),
        "around: leg whips": on_right(
            Leg(72.0, 46.0, -22.0, 62.0, 45.0),
            Turn(-4.0, -32.0, -66.0),
            Turn(2.0, 6.0, 26.0),
            Turn(0.0, 10.0, 30.0),
            stand=pivot,
            left_arm=low,
            bend=18.0,
        ),
        "around: leg stretched": on_right(
            Leg(70.0, 46.0, -24.0, 14.0, 45.0),
            Turn(-4.0, -34.0, -76.0),
            Turn(2.0, 6.0, 26.0),
            Turn(0.0, 10.0, 38.0),
            stand=pivot,
            left_arm=low,
            bend=16.0,
        ),
        "around: leg drawn back": on_right(
            Leg(68.0, 36.0, -14.0, 100.0, 30.0),
            Turn(-2.0, -22.0, -54.0),
            Turn(4.0, 6.0, 22.0),
            Turn(0.0, 6.0, 24.0),
            stand=pivot,
        ),
        "around: leg goes down": on_right(
            Leg(38.0, 14.0, 2.0, 74.0, 10.0),
            Turn(2.0, -6.0, -10.0),
            Turn(6.0, 0.0, 8.0),
            stand=replace(STAND, turn=-42.0),
        ),
    }
    _kick(made, "roundhouse kick", moments, (0.17, 0.32, 0.40, 0.46, 0.62, 0.86), 1.15)


def _ball(made: Composer) -> None:
    """The instep kick with the step before it; the ball lies before the right foot's left side."""
    plant = Foot(-0.11, 0.0, -4.0)
    wide = Arm(elevation=78.0, plane=-14.0, rotation=6.0, elbow=28.0, girdle=8.0)
    moments = {
        "ball: right leg strides": balanced(
            moment(
                left_leg=Foot(0.10, 0.86, 8.0, 30.0),
                right_leg=Leg(34.0, 2.0, 4.0, 34.0, -5.0),
                left_arm=swung_arm(24.0, 20.0, elbow=34.0),
                right_arm=swung_arm(-28.0, 26.0, elbow=24.0),
                bend=20.0,
                pelvis=Turn(6.0, 2.0, 6.0),
                waist=Turn(2.0, 0.0, -10.0),
            ),
            ahead_m=0.22,
        ),
        "ball: right foot plants": on_right(
            Leg(-24.0, 12.0, 8.0, 74.0, 35.0),
            Turn(-2.0, -8.0, 30.0),
            Turn(4.0, 0.0, -34.0),
            Turn(6.0),
            stand=replace(plant, pitch=-10.0),
            bend=20.0,
            left_arm=swung_arm(-30.0, 26.0, elbow=26.0),
            right_arm=wide,
            ahead_m=-0.24,
        ),
        "ball: thigh swings forward": on_right(
            Leg(-4.0, 14.0, 8.0, 104.0, 40.0),
            Turn(-4.0, -12.0, 10.0),
            Turn(6.0, -2.0, -16.0),
            Turn(12.0),
            stand=plant,
            bend=32.0,
            left_arm=swung_arm(-34.0, 30.0, elbow=24.0),
            right_arm=wide,
            ahead_m=-0.14,
        ),
        "ball: struck": on_right(
            Leg(22.0, 14.0, 6.0, 42.0, 45.0),
            Turn(-10.0, -12.0, -8.0),
            Turn(12.0, -2.0, 6.0),
            Turn(16.0),
            stand=plant,
            bend=36.0,
            left_arm=swung_arm(-30.0, 34.0, elbow=22.0),
            right_arm=replace(wide, plane=24.0),
            ahead_m=-0.10,
        ),
        "ball: leg through": on_right(
            Leg(58.0, 6.0, 2.0, 12.0, 40.0),
            Turn(-14.0, -8.0, -22.0),
            Turn(16.0, 0.0, 18.0),
            Turn(12.0),
            stand=replace(plant, pitch=14.0),
            bend=20.0,
            left_arm=swung_arm(-32.0, 36.0, elbow=22.0),
            right_arm=replace(wide, elevation=70.0, plane=66.0),
            ahead_m=-0.02,
        ),
        "ball: leg high": on_right(
            Leg(78.0, -4.0, 0.0, 26.0, 25.0),
            Turn(-12.0, -4.0, -30.0),
            Turn(18.0, 0.0, 24.0),
            Turn(8.0),
            stand=replace(plant, pitch=26.0),
            bend=14.0,
            left_arm=swung_arm(-24.0, 36.0, elbow=26.0),
            right_arm=replace(wide, elevation=62.0, plane=92.0, elbow=40.0),
            ahead_m=0.10,
        ),
        "ball: left foot lands": balanced(
            moment(
                left_leg=Foot(0.07, -0.52, 6.0, -6.0),
                right_leg=Foot(-0.11, 0.0, -4.0, 30.0),
                left_arm=swung_arm(-16.0, 24.0, elbow=30.0),
                right_arm=swung_arm(22.0, 24.0, elbow=44.0),
                bend=14.0,
                pelvis=Turn(6.0, 0.0, -10.0),
                waist=Turn(6.0, 0.0, 12.0),
            ),
            left=0.4,
        ),
    }
    times = (0.0, 0.22, 0.32, 0.40, 0.50, 0.64, 0.98)
    steps = [(made.pose(name, at), time_s) for (name, at), time_s in zip(moments.items(), times, strict=True)]
    made.motion("kick of a ball", steps)
    easy_kicks.run_up(made, "kick of a ball with a run-up", steps)


def _swing(made: Composer) -> None:
    """The leg all but straight, back and forward, as for warming up."""
    stand = Foot(-0.09, 0.0, -8.0)

    def at(flexion: float, knee: float, bow: float, arm: float) -> Moment:
        return on_right(
            Leg(flexion, 4.0, 4.0, knee, 15.0),
            Turn(bow, -3.0),
            Turn(4.0 - 0.5 * bow, 3.0),
            stand=stand,
            bend=9.0,
            left_arm=swung_arm(-arm, 24.0, elbow=22.0),
            right_arm=swung_arm(arm, 28.0, elbow=22.0),
        )

    both = moment(legs=Foot(0.09, 0.0, 8.0), arms=HANGING, bend=7.0)
    made.pose("standing", balanced(both))
    made.pose("swing: leg back", at(-22.0, 24.0, 9.0, 16.0))
    made.pose("swing: leg passes", at(10.0, 20.0, 2.0, 0.0))
    made.pose("swing: leg forward", at(48.0, 10.0, -5.0, -16.0))
    made.pose("swing: leg highest", at(72.0, 8.0, -10.0, -22.0))
    made.motion(
        "swing of the leg",
        [
            ("standing", 0.0),
            ("swing: leg back", 0.40),
            ("swing: leg passes", 0.60),
            ("swing: leg forward", 0.74),
            ("swing: leg highest", 0.90),
            ("swing: leg forward", 1.06),
            ("swing: leg passes", 1.22),
            ("standing", 1.50),
        ],
    )


def _kick(
    made: Composer, name: str, moments: dict[str, Moment], times: tuple[float, ...], back_s: float
) -> None:
    """From the guard through a kick and back to the guard."""
    steps = [(made.pose(pose, at), time_s) for (pose, at), time_s in zip(moments.items(), times, strict=True)]
    made.motion(name, [("guard", 0.0), *steps, ("guard", back_s)])
