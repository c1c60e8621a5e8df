"""Motions finished and mended, number by number."""

import numpy as np
from _performances import RATE, performance, seen_by_network, stepping
from _recorded import assert_recorded
from keymark.core.body.mirror import OPPOSITE
from keymark.core.body.posture import turned_and_shifted
from keymark.core.feet.contacts import find_contacts
from keymark.core.feet.fading import smooth_above
from keymark.core.feet.natural_extremities import natural_extremities
from keymark.core.feet.place_by_feet import place_by_feet
from keymark.core.feet.planted_feet import plant_feet
from keymark.core.feet.soles import Shins, Soles, ground_of
from keymark.core.keys.hermite import fit_keys, refit
from keymark.core.mend.mend_motion import MendOptions, exchanged_frames, mend_motion
from keymark.core.progress import run

FRAMES = 80
TIME_S = np.arange(FRAMES) / 30.0
BODY, STEPS = stepping()
STEPS = STEPS[:FRAMES]
POINTS = BODY.points(BODY.pose(STEPS))


def test_feet_and_hands() -> None:
    wandering = turned_and_shifted(STEPS, 0.0, np.array([0.0, 0.0, 0.015]))
    noisy = wandering.plus(0.002 * np.random.default_rng(1).normal(size=wandering.to_vector().shape))
    for name, posture in (("steps", STEPS), ("noisy", noisy)):
        planted = run(plant_feet(BODY, posture, TIME_S))
        assert_recorded(f"planted {name}", BODY.points(BODY.pose(planted.posture)), share=1e-4)
        rests = [[one.point, one.first, one.last, *one.place] for one in planted.contacts]
        assert_recorded(f"rests {name}", *rests, share=1e-4)
        turns = natural_extremities(BODY, posture, TIME_S).turns
        assert_recorded(f"extremities {name}", *(turns[key] for key in sorted(turns)), share=1e-4)
        source = performance(BODY, posture)
        assert_recorded(f"segments {name}", *(source.start[key] for key in sorted(source.start)))


def test_the_ground() -> None:
    ankles = [BODY.skeleton.point_names.index(f"ankle.{side}") for side in "LR"]
    contacts = find_contacts(POINTS[:, ankles], TIME_S)
    shins, soles = Shins.of(BODY, BODY.pose(STEPS)), Soles.of(BODY)
    ground = ground_of(BODY, BODY.pose(STEPS), TIME_S, contacts)
    assert_recorded("ground", ground.height_m, 100.0 * soles.clearance_m(shins))
    needed = np.maximum(np.sin(np.arange(FRAMES) / 5.0), 0.0)
    assert_recorded("smooth above", smooth_above(needed, TIME_S, 0.2))


def test_motions_mended() -> None:
    given = seen_by_network(POINTS, 2)
    exchanged = given.copy()
    exchanged[30:45] = given[30:45][:, OPPOSITE]
    for name, points in (("plain", given), ("exchanged", exchanged)):
        found = run(mend_motion(points, RATE, MendOptions()))
        assert_recorded(f"mended {name}", found.motion.points, share=1e-4)
        assert exchanged_frames(points).sum() == (15 if name == "exchanged" else 0)
    feet = POINTS[:, [11, 12]] - STEPS.translation[:, None]
    for given_m in (0.05, np.inf):
        placed = place_by_feet(STEPS.translation, feet, 30.0, given_m)
        assert_recorded(f"placed by feet {given_m}", placed, share=1e-4)


def test_curves_through_keys() -> None:
    data = np.stack([POINTS[:, 4, 2], POINTS[:, 8, 0]], axis=1)
    keys = np.array([0, 12, 30, 51, FRAMES - 1])
    exact = np.array([0, 30])
    curve = fit_keys(TIME_S, data, keys, exact)
    assert_recorded("curve", curve.evaluate(TIME_S, 0, FRAMES - 1))
    assert_recorded("refit", refit(TIME_S, data, curve, 1, 3, exact).evaluate(TIME_S, 0, FRAMES - 1))
