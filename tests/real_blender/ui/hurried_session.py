"""A person in a hurry: from the clip to a motion by Pose All and a few corrections, counting clicks.

Usage: as of session.py, without a step. Nothing is cancelled or undone on the way.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import steps_doubtful  # noqa: E402
import steps_match  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import Person  # noqa: E402

STEPS = (
    steps_prepare.footage,
    steps_prepare.markers,
    steps_prepare.actor,
    steps_match.pose_all,
    steps_doubtful.doubtful,
    steps_match.reconstruct,
)


def session(take: Path, folder: Path, camera: Camera) -> Steps[None]:
    """All steps in order; each tells how much work it was."""
    person = Person(take, folder, camera, hurried=True)
    yield from steps_prepare.start_empty(person)
    person.start_counting()
    for step in STEPS:
        yield from step(person)
        print(f"{step.__name__}: {person.summary()}", flush=True)
    summary = person.summary()
    (folder / "summary.txt").write_text(summary + "\n", encoding="utf-8")
    print(f"From the clip to the motion: {summary}", flush=True)


if __name__ == "__main__":
    take_name, folder_name = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(take_name), Path(folder_name), taking), taking)
