"""Convert a take as if its performer wore any clothes: run a detector on its clip, convert, score.

Usage: detect_demo.py TAKE OUTPUT COMMAND, with the Python of a virtual environment that has Keymark. TAKE
has `truth.json` and `keyframes_noisy.json` or `keyframes.json`; its markers and keypoints, if it has any, are
left aside. COMMAND is the detector's, as `keymark detect` takes it.
"""

import json
import shutil
import sys
from pathlib import Path

from keymark.core.estimate.reconstruct import reconstruct
from keymark.core.progress import run
from keymark.core.review.score import Score, read_truth, score_points
from keymark.core.take.motion_file import read_motion
from keymark.core.take.take_file import read_take
from keymark.operators.cli.main import main as keymark

LEFT_ASIDE = ("markers", "keypoints", "evidence")
"""Fields of take.json."""
POSED = ("keyframes_noisy.json", "keyframes.json")
"""Keyframe files, the first there is: those with a person's errors first."""


def write_plain_take(take: Path, plain: Path) -> None:
    """Copy a take without its markers."""
    fields = json.loads((take / "take.json").read_text(encoding="utf-8"))
    clip = take / fields.get("clip", "clip.mp4")
    fields = {name: value for name, value in fields.items() if name not in LEFT_ASIDE} | {"clip": clip.name}
    shutil.rmtree(plain, ignore_errors=True)
    plain.mkdir(parents=True)
    shutil.copyfile(clip, plain / clip.name)
    shutil.copyfile(next(take / name for name in POSED if (take / name).is_file()), plain / "keyframes.json")
    (plain / "take.json").write_text(json.dumps(fields, indent=1) + "\n", encoding="utf-8")


def scores(take: Path, plain: Path, result: Path) -> dict[str, Score]:
    """The errors of plain interpolation, and of the motion that was converted."""
    motion, read = read_motion(result / "motion.json"), read_take(plain)
    truth = read_truth(take / "truth.json", motion.frame_start, len(motion.time_s))
    posed = motion.keyframe_indices
    joined = run(reconstruct(read, "interpolation")).motion
    return {
        "interpolation": score_points(joined.points, truth, posed, read.camera),
        "keypoints and contours": score_points(motion.points, truth, posed, read.camera, motion.sigma_m),
    }


def main(arguments: list[str]) -> int:
    """Detect, convert and score; returns the exit status."""
    take, output, command = Path(arguments[0]), Path(arguments[1]), arguments[2]
    plain, result = output / "take", output / "result"
    write_plain_take(take, plain)
    status = keymark(["detect", str(plain), "--detector", command])
    status = status or keymark(["convert", str(plain), "--output", str(result)])
    if status:
        return status
    print("Error against the true motion in millimeters (all, about hips):")
    for name, score in scores(take, plain, result).items():
        values = score.to_dict()
        print(f"  {name:24}{values['mpjpe']:8.1f}{values['rooted']:8.1f}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
