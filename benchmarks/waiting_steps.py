"""What people wait for, a process each: `waiting_steps.py STEP FOLDER` measures one step of a take.

FOLDER holds a take, and beside it what earlier steps have left for later ones: the opened scene, the reading
of the clip, the reconstructed scene. The steps are the operators that the sidebar's buttons call. Printed are
seconds, processor seconds and the process's peak memory, which includes Blender's own.

`make_take FOLDER SOURCE WIDTH HEIGHT FRAMES` and `make_character FOLDER` make what is measured.
"""

import json
import os
import shutil
import sys
import time
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from clock import peak_memory_mb
from takes import load_project

CLIP, KEYPOINTS = "clip.mp4", "keypoints.json"
OPENED, MOVED, READ = "opened.blend", "moved.blend", "read"
"""Scenes as opened and as reconstructed, and the folder of the clip's readings."""
CHARACTER = "character.blend"
"""In the folder above: Rigify's basic human, once for all takes."""
Step = Callable[[Path], Callable[[], object]]
"""Makes everything ready in a take's folder, and returns the work that is measured."""


def decode(folder: Path) -> Callable[[], object]:
    """Decoding alone, by OpenCV, without Blender."""
    import cv2

    def work() -> None:
        capture = cv2.VideoCapture(str(folder / CLIP))
        while capture.read()[0]:
            pass

    return work


def animate(folder: Path) -> Callable[[], object]:
    """From a bare clip and a height to the motion, as `core/api` goes; what each stage takes."""
    load_project()
    from animate import timed
    from keymark.core.api import animate as from_clip

    def work() -> dict[str, float]:
        with TemporaryDirectory() as place:
            clip = Path(place) / CLIP
            shutil.copy(folder / CLIP, clip)  # away from the keypoints beside it
            return timed(from_clip(clip, 1.7))[1]

    return work


def start(_folder: Path) -> Callable[[], object]:
    """Starting Blender with the extension, with nothing open."""
    return _blender


def open_take(folder: Path) -> Callable[[], object]:
    """Opening the take into an empty scene."""
    bpy = _blender()
    return lambda: bpy.ops.keymark.open_take(filepath=str(folder / "take.json"))


def read(folder: Path) -> Callable[[], object]:
    """Following the markers, and keeping the small pictures in which contours are sought."""
    bpy = _blender(folder / OPENED)
    return bpy.ops.keymark.propose_keyframes


def read_keypoints(folder: Path) -> Callable[[], object]:
    """The same of plain clothes: keypoints from a file, and the pictures."""
    bpy = _blender(folder / OPENED)
    _put_reading(bpy, folder)  # which knows the times of the frames, as the session does that opened the take

    def work() -> None:
        bpy.ops.keymark.load_keypoints(filepath=str(folder / KEYPOINTS), replace=True)
        _take(bpy).follow.use_markers = False
        bpy.ops.keymark.propose_keyframes()

    return work


def pose_all(folder: Path) -> Callable[[], object]:
    """Finding the keyframes, where nothing is posed and the clip is read."""
    bpy = _unposed(folder)
    return bpy.ops.keymark.pose_all


def reconstruct(folder: Path, method: str = "map") -> Callable[[], object]:
    """Reconstructing from posed keyframes, where the clip is read, up to the Action and its review."""
    bpy = _blender(folder / OPENED)
    _put_reading(bpy, folder)
    _take(bpy).method = method
    return bpy.ops.keymark.reconstruct


def filter_motion(folder: Path) -> Callable[[], object]:
    """The same by the paper's filter."""
    return reconstruct(folder, "ekf")


def bake(folder: Path) -> Callable[[], object]:
    """Planting the feet and reducing the motion to few keys, in the final Action."""
    bpy = _blender(folder / MOVED)
    return bpy.ops.keymark.bake_motion


def retarget(folder: Path) -> Callable[[], object]:
    """Recognizing the bones of a control rig, and putting the motion onto it."""
    bpy = _blender(folder / MOVED)
    rig = _character(folder)

    def work() -> None:
        bpy.ops.keymark.add_character(armature=rig.name)
        bpy.ops.keymark.retarget()

    return work


def copy_rotations(folder: Path) -> Callable[[], object]:
    """What people do without Keymark: constraints to the actor's bones, and Blender's own bake."""
    bpy = _blender(folder / MOVED)
    rig = _character(folder)
    import rotation_copying
    from keymark.core.retarget.recognition.recognize import recognize
    from keymark.operators.bridge.character.read_character import read_character

    take, scene = _take(bpy), bpy.context.scene
    known = recognize(read_character(rig)).character_map
    frames = (scene.frame_start, scene.frame_end)
    return lambda: rotation_copying.copy_rotations(take.armature, rig, known, frames)


STEPS: dict[str, Step] = {
    step.__name__: step
    for step in (
        decode,
        animate,
        start,
        open_take,
        read,
        read_keypoints,
        pose_all,
        reconstruct,
        filter_motion,
        bake,
        retarget,
        copy_rotations,
    )
}
KEPT = {open_take.__name__: OPENED, reconstruct.__name__: MOVED}
"""Steps after which the scene is saved for later ones."""


def _blender(file: Path | None = None) -> Any:
    """Blender's module with the extension, and a file opened, or an empty scene."""
    load_project()
    import bpy
    import keymark

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    keymark.register()
    if file is not None:
        bpy.ops.wm.open_mainfile(filepath=str(file))
    return bpy


def _take(bpy: Any) -> Any:
    from keymark.operators.shell.takes import active_take

    return active_take(bpy.context.scene)


def _unposed(folder: Path) -> Any:
    """Blender with the opened take, without its keyframes, and its clip read."""
    bpy = _blender(folder / OPENED)
    _take(bpy).keyframe_action = None
    _put_reading(bpy, folder)
    return bpy


def _character(folder: Path) -> Any:
    from _armatures import add_rig

    return add_rig(folder.parent / CHARACTER)


def _put_reading(bpy: Any, folder: Path) -> None:
    """Keep a take's reading in the session, as if the clip had been read in it."""
    from keymark.core.files.digest import ArrayCache
    from keymark.core.markers.reading import reading_from_arrays
    from keymark.operators.shell.results import keep_reading

    arrays = ArrayCache(folder / READ).load(READ)
    assert arrays is not None, f"{folder}: was not read before"
    keep_reading(_take(bpy), reading_from_arrays(arrays))


def _keep_reading(bpy: Any, folder: Path) -> None:
    from keymark.core.files.digest import ArrayCache
    from keymark.core.markers.reading import reading_arrays
    from keymark.operators.shell.results import reading_of

    reading = reading_of(_take(bpy))
    assert reading is not None
    ArrayCache(folder / READ).save(READ, reading_arrays(reading))


def measure(step: str, folder: Path) -> dict[str, Any]:
    """Measure a step of a take, and keep what later steps need."""
    work = STEPS[step](folder)
    began, spent = time.perf_counter(), time.process_time()
    ended = work()
    stages = ended if isinstance(ended, dict) else {}
    if isinstance(ended, set) and ended != {"FINISHED"}:
        raise SystemExit(f"{step} ended with {ended}")
    found = {
        "seconds": time.perf_counter() - began,
        "processor_s": time.process_time() - spent,
        "peak_mb": peak_memory_mb(),
        "stages": stages,
    }
    if step == read.__name__ or step in KEPT:
        import bpy

        if step == read.__name__:
            _keep_reading(bpy, folder)
        else:
            bpy.ops.wm.save_as_mainfile(filepath=str(folder / KEPT[step]))
    return found


def make_take(folder: Path, source: str, width: str, height: str, frames: str) -> None:
    """Make a take of another one's pictures, enlarged and repeated."""
    from enlarged_take import enlarged

    enlarged(Path(source), (int(width), int(height)), int(frames), folder)


def make_character(folder: Path) -> None:
    """Make the character that all motions are retargeted to."""
    load_project()
    from _armatures import rigify_file

    rigify_file(folder).replace(folder / CHARACTER)


def main(step: str, folder: Path, *words: str) -> None:
    """Measure a step, or make what steps need."""
    makers = {maker.__name__: maker for maker in (make_take, make_character)}
    if step in makers:
        makers[step](folder, *words)
        print("{}")
    else:
        print(json.dumps(measure(step, folder)))


if __name__ == "__main__":
    main(sys.argv[1], Path(sys.argv[2]), *sys.argv[3:])
    sys.stdout.flush()
    os._exit(0)  # with an extension registered, Blender as a module may crash or hang when it ends as usual
