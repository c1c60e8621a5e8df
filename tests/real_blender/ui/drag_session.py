"""The most doubtful poses put right by mouse, joint by joint where the performer is seen, and the motion held
against the truth before and after.

Usage: as of session.py, without a step, then a file of keypoints in the take's folder and numbers of poses
that are put right, as in `keypoints.json 1,2,4`. `errors.json` then holds the errors of the motions in mm.
"""

import json
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parents[1])]

import bpy  # noqa: E402
import steps_correct  # noqa: E402
import steps_doubtful  # noqa: E402
import steps_prepare  # noqa: E402
from driver import Camera, Steps, drive, expect, turns  # noqa: E402
from person import Person, keymark  # noqa: E402

ORDER = ("hip", "shoulder", "elbow", "wrist", "knee", "ankle")
RIGHT_PX = 2.0  # A joint this near to where it should be seen is left alone


def session(take: Path, folder: Path, camera: Camera, keypoints: str, counts: list[int]) -> Steps[None]:
    """Find all poses, put some right, and reconstruct before and after."""
    person = Person(take, folder, camera, hurried=True)
    yield from steps_prepare.clip(person)
    steps_prepare.performer(person, keypoints)
    bpy.ops.keymark.pose_all()
    person.step_done("Find all poses")
    errors = {"0": error_mm(person)}
    done: set[int] = set()
    for count in range(1, max(counts) + 1):
        yield from put_right(person, done)
        if count in counts:
            errors[str(count)] = error_mm(person)
            print(f"{count} put right: {errors}", flush=True)
    yield from person.look("put_right")
    (folder / "errors.json").write_text(json.dumps(errors) + "\n", encoding="utf-8")


def put_right(person: Person, done: set[int]) -> Steps[None]:
    """Go to the most doubtful pose that is left, and drag every joint to where the performer has it."""
    bpy.ops.keymark.show_action(which="KEYFRAMES")
    matches = [each for each in person.take.matching.matches if round(each.frame) not in done]
    frame = round(min(matches, key=lambda match: match.confidence).frame)
    done.add(frame)
    person.scene.frame_set(frame)
    person.step_done("Go to a doubtful pose")
    yield from turns(3)
    yield from steps_correct.begun(person)
    truth = steps_doubtful.performer(person)
    places = dict(zip(keymark("core.body.human").HUMAN.point_names, truth, strict=True))
    left = ["head", *(f"{joint}.{side}" for joint in ORDER for side in "LR")]
    for _ in range(2):  # a joint that lies behind another one is reached once that has been moved
        again = []
        for joint in left:
            is_set = yield from set_joint(person, joint, places[joint])
            again += [joint] * (not is_set)
        left = again
    expect(len(left) < 4, f"{left} cannot be dragged at frame {frame}")
    yield from steps_correct.ended(person, "RET")


def set_joint(person: Person, joint: str, place: steps_doubtful.Points) -> Steps[bool]:
    """Drag a joint to where a place is seen; whether it lies there now."""
    start, end = steps_correct.seen(person, joint), steps_correct.seen_at(person, place)
    if steps_correct.apart_px(start, end) > RIGHT_PX:
        yield from person.hands.drag(start, end)
    return steps_correct.apart_px(steps_correct.seen(person, joint), end) < steps_correct.NEAR_PX


def error_mm(person: Person) -> tuple[float, float]:
    """Errors of the motion with hips aligned, and in place."""
    bpy.ops.keymark.reconstruct()
    person.step_done("Reconstruct")
    made = reversed(keymark("operators.shell.results").MADE.values())
    motion = next(result.motion for result in made if hasattr(result, "motion"))
    score = keymark("core.review.score")
    known = person.known
    truth = score.read_truth(known.folder / "truth.json", known.frame_start, len(motion.points))
    found = score.score_points(motion.points, truth, (), known.camera)
    return round(found.rooted, 1), round(found.mpjpe_all, 1)


if __name__ == "__main__":
    take_name, folder_name, file_name, numbers = sys.argv[sys.argv.index("--") + 1 :]
    taking = Camera(Path(folder_name))
    chosen = [int(number) for number in numbers.split(",")]
    drive(session(Path(take_name), Path(folder_name), taking, file_name, chosen), taking)
