"""How heads, palms and fingers are off that a clip shows, beside those laid by rule.

Usage: extremities.py [TAKE ...] with folders of takes that have truth_full.json. See README.md.
"""

import json
import sys
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from takes import OUTPUT, ROOT, load_project, write_results

load_project()

from keymark.core.api import convert  # noqa: E402
from keymark.core.arrays import Array  # noqa: E402
from keymark.core.body.fingers import RELAXED_RAD, RESTING, SURE, curls_of, palm_of  # noqa: E402
from keymark.core.body.kinematics import segment_motion  # noqa: E402
from keymark.core.body.posture_fit import nearest_rotation  # noqa: E402
from keymark.core.body.rotations import logarithm  # noqa: E402
from keymark.core.detect.closer_look import CloserLook  # noqa: E402
from keymark.core.detect.keypoint_file import write_keypoints  # noqa: E402
from keymark.core.detect.keypoints import no_face, no_hands  # noqa: E402
from keymark.core.detect.pose_network import PoseNetwork  # noqa: E402
from keymark.core.detect.pose_tracking import find_people  # noqa: E402
from keymark.core.estimate.reconstruct import Reconstruction  # noqa: E402
from keymark.core.feet.natural_extremities import natural_extremities  # noqa: E402
from keymark.core.prior.registry import find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.take.conversion_settings import ConversionSettings  # noqa: E402
from keymark.core.take.description import describe  # noqa: E402
from keymark.core.take.motion import Motion  # noqa: E402
from keymark.core.take.read_footage import open_footage  # noqa: E402

GIVEN = ROOT.parent / "shared" / "heads"
LARGE_PX = 45.0  # length of a hand from which it is expected to be seen


@dataclass(frozen=True)
class Row:
    """Figures of a take."""

    take: str
    head_deg: float
    head_90_deg: float
    spread: float  # the head's against the trunk, by the truth's
    rule_head_deg: float
    palms_deg: float  # all frames
    rule_palms_deg: float
    sure: float  # share of the frames in which a hand is large enough
    sure_palms_deg: float
    sure_palms_90_deg: float
    sure_palms_over_45: float
    unsure_palms_deg: float
    rule_unsure_palms_deg: float
    curls_deg: float  # all frames; mean over fingers
    rule_curls_deg: float
    sure_curls_deg: float
    sure_curls_over_30: float


def angles_deg(one: Array, other: Array) -> Array:
    """(...) angles between rotations (..., 3, 3)."""
    return np.degrees(np.linalg.norm(logarithm(np.swapaxes(one, -1, -2) @ other), axis=-1))


def aligned(turn: Array, truth: Array) -> Array:
    """Turns (F, 3, 3) without the constant turn by which definitions differ: a mean over the better half."""
    apart, kept = np.swapaxes(turn, -1, -2) @ truth, np.ones(len(turn), dtype=bool)
    for _ in range(3):
        turned = turn @ nearest_rotation(apart[kept].mean(axis=0)[None])[0]
        off = angles_deg(turned, truth)
        kept = off <= np.median(off)
    return np.asarray(turned)


def spread_deg(head: Array, trunk: Array) -> float:
    """Deviation of a head's turn against the trunk."""
    against = np.swapaxes(trunk, -1, -2) @ head
    middle = nearest_rotation(against.mean(axis=0)[None])
    return float(np.sqrt(np.mean(angles_deg(np.broadcast_to(middle, against.shape), against) ** 2)))


def detected(folder: Path) -> tuple[Path, Path]:
    """The files of a clip's keypoints with faces and hands, and without; made once."""
    kept = OUTPUT / "extremities" / f"{folder.name}.json"
    plain = kept.with_suffix(".plain.json")
    if not plain.is_file():
        values = describe(folder).fields.values
        clip = open_footage(folder / "clip.mp4", values["fps"], tuple(values["camera"]["resolution"]))
        people = run(find_people(clip, PoseNetwork(), CloserLook()))
        frames = tuple(replace(one, face=no_face(), hands=no_hands()) for one in people.frames)
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_keypoints(kept, people, 1, values["fps"])
        write_keypoints(plain, replace(people, frames=frames), 1, values["fps"])
    return kept, plain


def motion_of(folder: Path, keypoints: Path) -> Motion:
    """The motion of a take that nobody has posed, by a file of keypoints."""
    settings = ConversionSettings(library="auto", keypoints=(keypoints,))
    libraries = find_libraries(EVERY_LIBRARY, [ROOT / "presets" / "keyframes"])
    return run(convert(describe(folder), settings, libraries))[Reconstruction].motion


def measure(folder: Path) -> Row:
    """A take's figures."""
    full = json.loads((folder / "truth_full.json").read_text(encoding="utf-8"))
    world = np.swapaxes(np.array(full["rotation"]), -1, -2)
    head, trunk = (
        world @ np.array([one[f"{name}_turn"] for one in full["frames"]]) for name in ("head", "trunk")
    )
    points = np.array([[one["hands"][side] for side in "LR"] for one in full["frames"]])
    palm = np.stack([world @ palm_of(points[:, row], side) for row, side in enumerate("LR")], axis=1)
    curls = curls_of(points)
    seen, rule = (motion_of(folder, keypoints) for keypoints in detected(folder))
    parts = {}
    for name, motion in (("seen", seen), ("rule", rule)):
        turns = natural_extremities(motion.body, motion.posture, motion.time_s, hands=motion.hands)
        segments = segment_motion(motion.body, motion.posture, motion.time_s, turns)
        palms = np.stack([segments.turn[f"hand.{side}"] @ RESTING[side] for side in "LR"], axis=1)
        parts[name] = segments.turn["head"], segments.turn["chest"], angles_deg(palms, palm)
    hands = seen.hands
    off = [angles_deg(aligned(parts[name][0], head), head) for name in parts]
    length_px = full["f"] * 0.19 / points[:, :, 0, 2]  # of a usual hand
    large = length_px > LARGE_PX
    sure = (hands.sure > SURE) & large
    bent = [np.abs(np.degrees(own - curls)).mean(axis=-1) for own in (hands.curls, RELAXED_RAD)]
    palms, ruled = parts["seen"][2], parts["rule"][2]
    return Row(
        folder.name,
        *(float(np.quantile(off[0], share)) for share in (0.5, 0.9)),
        spread_deg(*parts["seen"][:2]) / spread_deg(head, trunk),
        float(np.median(off[1])),
        float(np.median(palms)),
        float(np.median(ruled)),
        float(sure[large].mean()),
        *(float(np.quantile(palms[sure], share)) for share in (0.5, 0.9)),
        float((palms[sure] > 45.0).mean()),
        *(float(np.median(own[~sure])) for own in (palms, ruled)),
        *(float(own.mean()) for own in bent),
        float(bent[0][sure].mean()),
        float((bent[0][sure] > 30.0).mean()),
    )


def main(arguments: list[str]) -> None:
    """Measure and write the table."""
    folders = [Path(one) for one in arguments] or [
        file.parent for file in sorted(GIVEN.glob("*/truth_full.json"))
    ]
    rows = [asdict(measure(folder)) for folder in folders]
    lines = ["| | " + " | ".join(row["take"] for row in rows) + " |", "|---|" + "---|" * len(rows)]
    for name in list(rows[0])[1:]:
        values = (f"{row[name]:.2f}" if abs(row[name]) < 2.0 else f"{row[name]:.1f}" for row in rows)
        lines.append(f"| {name.replace('_', ' ')} | " + " | ".join(values) + " |")
    write_results("extremities", "\n".join(lines), json.dumps(rows, indent=1))


if __name__ == "__main__":
    main(sys.argv[1:])
