"""A person's session: from an empty scene through all steps to a motion, by mouse and keys.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python session.py -- TAKE FOLDER

TAKE's files stand for what the animator knows and sees: how the camera stood, how long the performer's limbs are,
where the sleeves are in the picture, how the performer stands at the keyframes. FOLDER gets the pictures of the
screen and `motion.json`, the 13 points that the finished armature shows.
"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

import steps_finish  # noqa: E402
import steps_prepare  # noqa: E402
import steps_reconstruct  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import Person  # noqa: E402


def session(take: Path, folder: Path, camera: Camera) -> Steps[None]:
    """All steps in order."""
    person = Person(take, folder, camera)
    yield from steps_prepare.start_empty(person)
    yield from steps_prepare.footage(person)
    yield from steps_prepare.markers(person)
    yield from steps_prepare.actor(person)
    yield from steps_reconstruct.keyframes(person)
    yield from steps_reconstruct.reconstruct(person)
    yield from steps_finish.review(person)
    yield from steps_finish.finish(person)


if __name__ == "__main__":
    take, folder = (Path(word) for word in sys.argv[sys.argv.index("--") + 1 :][:2])
    camera = Camera(folder)
    drive(session(take, folder, camera), camera)
