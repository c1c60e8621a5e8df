"""Somebody's first minutes with Keymark: from Blender as it starts to an example on a Rigify character.

Usage: blender-screen --factory-startup --addons MODULE --enable-event-simulate --python first_session.py
       -- FOLDER

By the README alone, by mouse and keys: every click and key is counted, and each step leaves a picture in
FOLDER. Afterwards, uncounted, one Ctrl Z takes back one step, and the other example is copied to a folder.
"""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import steps_first  # noqa: E402
from driver import Camera, Steps, drive  # noqa: E402
from person import EXTENSION, Person  # noqa: E402

STEPS = (
    steps_first.sidebar,
    steps_first.example,
    steps_first.reconstruct,
    steps_first.play,
    steps_first.review,
    steps_first.character,
    steps_first.retarget,
    steps_first.play,
)


def session(folder: Path, camera: Camera) -> Steps[None]:
    """All steps in order; each tells how much work it was so far."""
    example = Path(sys.modules[EXTENSION].__file__).parent / "presets" / "demo" / "aerobic"
    person = Person(example, folder, camera, hurried=True)
    for step in STEPS:
        yield from step(person)
        print(f"{step.__name__}: {person.summary()}", flush=True)
    summary = person.summary()
    (folder / "summary.txt").write_text(summary + "\n", encoding="utf-8")
    print(f"From Blender as it starts to the character: {summary}", flush=True)
    yield from steps_first.take_back(person)
    yield from steps_first.copy(person)


if __name__ == "__main__":
    (folder_name,) = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    drive(session(Path(folder_name), taking), taking)
