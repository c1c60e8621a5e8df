"""What whole motions of the libraries tell of a clip, part by part.

A motion that a library knows ties limbs and moments to each other, which parts composed freely lack: which
arm swings with which leg, and when. So the library that is nearest to a first composition is matched with the
clip as a whole, and makes parts near its own likelier, the more the surer the match is. A part that it has
wrong is left to the evidence: the belief is bounded.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from operator import itemgetter

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.heading import headings_rad, yawed_at
from ..body.human import HUMAN
from ..body.kinematics import Body
from ..body.limbs import LIMBS
from ..body.posture import Posture
from ..library.library import Library
from ..matching.coarse_pass import single_posture_cost
from ..matching.library_match import match_library, prepare_library
from ..matching.match_input import MatchInput
from ..progress import Part, scaled
from .part_features import TRUNK_POINTS, StanceFeatures, limb_points
from .part_pools import ARM, PartPools

MOST_COMPARED = 4
"""Libraries whose single postures are compared with the footage: those nearest to a first composition."""
COMPARED_SHARE = 0.3
"""Share of the work after which they are."""
PERFORMERS_M = 0.10
"""Distance of a part's points between performers at the same moment of a motion."""
CERTAINTY = 10.0
"""How many times likelier parts at a match's own places are than others if the match is as likely right as
not: a pool has some ten parts of each kind within what performers differ by."""


@dataclass(frozen=True, eq=False)
class PartBelief:
    """What one frame's parts cost less for being near a match's: 0 far from it, negative near it."""

    stance: SingleArray
    """(S,) of the stances."""
    limbs: dict[str, SingleArray]
    """(L,) of each limb's parts, by limb."""


def part_beliefs(
    given: MatchInput,
    libraries: Sequence[Library],
    pools: PartPools,
    stances: StanceFeatures,
    sampled: IndexArray,
    posture: Posture,
    floor_m: float,
) -> Part[list[PartBelief]]:
    """What the library that fits a clip best tells of some frames.

    Args:
        given: The take.
        libraries: All libraries.
        pools: Their parts.
        stances: The stances and limbs of these.
        sampled: (T,) the frames.
        posture: (N,) a first composition of some frames of the clip.
        floor_m: Height of the floor.

    Yields:
        The fraction done.
    """
    camera, evidence = given.camera, given.evidence
    compared = []
    nearest = nearest_libraries(pools, posture)[:MOST_COMPARED]
    for turn, number in enumerate(nearest):
        prepared = prepare_library(given, libraries[number])
        cost = single_posture_cost(camera, evidence, sampled, prepared.states, floor_m)
        compared.append((cost, prepared))
        yield COMPARED_SHARE * (turn + 1) / len(nearest)
    _, best = min(compared, key=itemgetter(0))
    match = yield from scaled(match_library(given, best, floor_m), COMPARED_SHARE, 1.0)
    sure = float(np.mean([frame.candidates[0].confidence for frame in match.frames]))
    return _beliefs(given.body, stances, match.postures[sampled], CERTAINTY * sure / (1.0 - sure))


def nearest_libraries(pools: PartPools, posture: Posture) -> list[int]:
    """Numbers of the libraries by how near they have a posture to each of some (N,), in any heading."""
    body = pools.body
    facing = yawed_at(posture, -headings_rad(posture), np.zeros_like(posture.translation))
    shapes, known = (body.points(body.pose(each)) for each in (facing, pools.known))
    away = np.array([np.linalg.norm(known - shape, axis=-1).mean(axis=-1) for shape in shapes])
    numbers = np.unique(pools.library)
    nearest = [away[:, pools.library == number].min(axis=1).mean() for number in numbers]
    return [int(number) for number in numbers[np.argsort(nearest, kind="stable")]]


def _beliefs(body: Body, stances: StanceFeatures, posture: Posture, odds: float) -> list[PartBelief]:
    """Beliefs in the parts of postures (T,), which are `odds` times likelier than parts far away."""
    pose = body.pose(posture)
    points, origin = (each - posture.translation[:, None] for each in (body.points(pose), pose.origin))
    waist = HUMAN.joint_index("waist")
    found = []
    for row in range(len(points)):
        limbs = {}
        for limb in LIMBS:
            joint = waist if limb.startswith(ARM) else 0
            local = (points[row, limb_points(limb)] - origin[row, joint]) @ pose.rotation[row, joint]
            limbs[limb] = _cost(stances.limbs[limb].points, local, odds)
        trunk = stances.features.points[:, TRUNK_POINTS]
        found.append(PartBelief(_cost(trunk, points[row, TRUNK_POINTS], odds), limbs))
    return found


def _cost(parts: SingleArray, believed: Array, odds: float) -> SingleArray:
    """(N,) cost of parts (N, Q, 3) near a believed one (Q, 3)."""
    squared = ((parts - believed.astype(np.float32)) ** 2).sum(axis=-1).mean(axis=-1)
    nearness = np.exp(np.float32(-0.5 / PERFORMERS_M**2) * squared)
    return np.asarray(-np.log1p(np.float32(odds) * nearness))
