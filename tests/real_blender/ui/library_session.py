"""A person's session without posing, step by step: a library is tried, then all is posed and a choice made.

Usage: as of session.py, with the name of a library instead of the step to begin at.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import steps_match  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import Person  # noqa: E402


def session(take: Path, folder: Path, camera: Camera, library: str) -> Steps[None]:
    """All steps in order, each undone and redone, and what can be cancelled cancelled once."""
    person = Person(take, folder, camera)
    for step in (
        steps_prepare.start_empty,
        steps_prepare.footage,
        steps_prepare.markers,
        steps_prepare.actor,
    ):
        yield from step(person)
    yield from steps_match.match(person, library)
    yield from steps_match.pose_all(person)
    yield from steps_match.choose(person)


if __name__ == "__main__":
    take_name, folder_name, wanted = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(take_name), Path(folder_name), taking, wanted), taking)
