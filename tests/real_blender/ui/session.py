"""A person's session: from an empty scene through all steps to a motion, by mouse and keys.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python session.py
       -- TAKE FOLDER [STEP]

TAKE's files stand for what the animator knows and sees: how the camera stood, how long the performer's
limbs are, where the sleeves are in the picture, how the performer stands at the keyframes. FOLDER gets
pictures of the screen and `motion.json`, the 13 points that the finished armature shows. STEP, from 1,
begins there instead, with the take opened from its files.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import steps_character  # noqa: E402
import steps_correct  # noqa: E402
import steps_finish  # noqa: E402
import steps_prepare  # noqa: E402
import steps_reconstruct  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import Person  # noqa: E402

STEPS = (
    steps_prepare.footage,
    steps_prepare.markers,
    steps_prepare.actor,
    steps_reconstruct.keyframes,
    steps_correct.correct,
    steps_reconstruct.reconstruct,
    steps_finish.review,
    steps_finish.finish,
    steps_character.character,
)


def session(take: Path, folder: Path, camera: Camera, first: int) -> Steps[None]:
    """All steps in order, or those from `first` on for a take that is opened from its files."""
    person = Person(take, folder, camera)
    yield from steps_prepare.start_empty(person)
    if first > 0:
        yield from steps_prepare.opened(person, first > STEPS.index(steps_reconstruct.reconstruct))
    for step in STEPS[first:]:
        yield from step(person)


if __name__ == "__main__":
    take_name, folder_name, *first_step = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    number = int(first_step[0]) - 1 if first_step else 0
    drive(session(Path(take_name), Path(folder_name), taking, number), taking)
