"""A person's session with plain clothes: footage, keypoints, actor, keyframes, the motion.

Usage: as of session.py, without a step; TAKE has no markers, but keypoints.json, which is loaded by hand.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import steps_finish  # noqa: E402
import steps_follow  # noqa: E402
import steps_prepare  # noqa: E402
import steps_reconstruct  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import Person  # noqa: E402

STEPS = (
    steps_prepare.start_empty,
    steps_prepare.footage,
    steps_follow.keypoints,
    steps_follow.clip_editor,
    steps_prepare.actor,
    steps_reconstruct.keyframes,
    steps_reconstruct.reconstruct,
    steps_finish.review,
)


def session(take: Path, folder: Path, camera: Camera) -> Steps[None]:
    """All steps in order; at the end the points that the armature shows are written down."""
    person = Person(take, folder, camera)
    for step in STEPS:
        yield from step(person)
    points = yield from steps_finish.shown_points(person)
    steps_finish.write_points(person, "motion.json", points)
    print(f"{person.hands.clicks} clicks in all")


if __name__ == "__main__":
    take_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(take_name), Path(folder_name), taking), taking)
