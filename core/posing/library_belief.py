"""What whole motions of the libraries tell of a clip, part by part.

A motion that a library knows ties limbs and moments to each other, which parts composed freely lack: which arm
swings with which leg, and when. So the libraries nearest to a first composition are matched with the clip as
wholes, and the one that explains it best makes parts near its own likelier, the more the surer it is. A limb
that it has wrong is left to the evidence.
"""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array, IndexArray, SingleArray
from ..body.heading import headings_rad, yawed_at
from ..body.posture import Posture
from ..library.library import Library
from ..matching.library_match import LibraryMatch, match_library, prepare_library
from ..matching.match_input import MatchInput
from ..matching.posture_sequences import library_sequences
from ..progress import Part, scaled
from .part_belief import PartBelief
from .part_features import StanceFeatures, limb_points
from .part_pools import LIMBS
from .posed_costs import TRUNK_POINTS

MOST_PREPARED = 4
"""Libraries that single frames are compared with: the nearest ones."""
PERFORMERS_M = 0.10
"""Distance of a part's points between performers at the same moment of a motion."""
CERTAINTY = 10.0
"""How many times likelier parts at a match's own places are than others if a match is as likely right as not."""


def nearest_libraries(given: MatchInput, libraries: Sequence[Library], posture: Posture) -> list[Library]:
    """The libraries whose postures are nearest to composed ones (T,), the nearest first."""
    body = given.body
    shape = _shapes(given, posture)
    away = []
    for library in libraries:
        sequences = library_sequences(library, body)
        known = _shapes(given, sequences.posture)
        apart = [np.linalg.norm(known - one, axis=-1).mean(axis=-1).min() for one in shape]
        away.append(float(np.mean(apart)))
    return [libraries[row] for row in np.argsort(away)]


def _shapes(given: MatchInput, posture: Posture) -> Array:
    ahead = yawed_at(posture, -headings_rad(posture), np.zeros((len(posture.translation), 3)))
    return np.asarray(given.body.points(given.body.pose(ahead)))


def part_beliefs(
    given: MatchInput,
    libraries: Sequence[Library],
    stances: StanceFeatures,
    sampled: IndexArray,
    posture: Posture,
    floor_m: float,
) -> Part[list[PartBelief]]:
    nearest = nearest_libraries(given, libraries, posture)[:MOST_PREPARED]
    prepared = []
    for turn, library in enumerate(nearest):
        prepared.append(prepare_library(given, library))
        yield 0.3 * (turn + 1) / len(nearest)
    best = yield from scaled(match_library(given, min(prepared, key=lambda each: each.coarse_pass.cost), floor_m), 0.3, 1.0)
    sure = float(np.mean([frame.candidates[0].confidence for frame in best.frames]))
    import os
    odds = float(os.environ.get("CERT", CERTAINTY)) * sure / (1.0 - sure)
    if os.environ.get("VERBOSE"): print([l.identifier for l in nearest], best.library.identifier, round(best.fit,2), round(sure,2), round(odds,1))
    return _beliefs(given, stances, best.postures[sampled], odds)


def _beliefs(given: MatchInput, stances: StanceFeatures, posture: Posture, odds: float) -> list[PartBelief]:
    body = given.body
    pose = body.pose(posture)
    points = body.points(pose) - posture.translation[:, None]
    waist = body.skeleton.joint_index("waist")
    found = []
    for row in range(len(points)):
        off = stances.features.points[:, TRUNK_POINTS] - points[row, TRUNK_POINTS].astype(np.float32)
        limbs = {}
        for limb in LIMBS:
            joint = waist if limb.startswith("arm") else 0
            turn = pose.rotation[row, joint]
            origin = pose.origin[row, joint] - posture.translation[row]
            local = (points[row, limb_points(limb)] - origin) @ turn
            limbs[limb] = _cost(stances.limbs[limb].points - local.astype(np.float32), odds)
        import os
        m=os.environ.get('BMODE','all')
        st=_cost(off, odds)
        if m=='limbs': st=st*0
        for l in limbs:
            if m=='torso' or (m=='legs' and l[:3]=='arm') or (m=='arms' and l[:3]=='leg'): limbs[l]=limbs[l]*0
        found.append(PartBelief(st, limbs))
    return found


def _cost(off: SingleArray, odds: float) -> SingleArray:
    squared = (off**2).sum(axis=-1).mean(axis=-1) / np.float32(PERFORMERS_M**2)
    return np.asarray(-np.log1p(np.float32(odds) * np.exp(-0.5 * squared)), dtype=np.float32)
