"""What files of keypoints say of themselves is believed: frame numbers, times, canvas; repeats count once."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _keypoints import FRAMES, SIZE, coco_value, mediapipe_value, moving_person, openpose_frame
from keymark.core.detect.detected_frames import stated_frames
from keymark.core.detect.keypoint_file import read_keypoints
from keymark.core.detect.keypoints import People
from keymark.core.detect.layouts import LAYOUTS
from keymark.core.errors import InputError

BLAZEPOSE33, OPENPOSE25 = LAYOUTS["blazepose33"], LAYOUTS["body25"]
FPS = 30.0


def read(folder: Path, value: Any, frames: int = FRAMES, start: int = 1) -> People:
    path = folder / "seen.json"
    path.write_text(json.dumps(value), encoding="utf-8")
    return read_keypoints(path, frames, SIZE, FPS, start)


def seen(people: People) -> list[int]:
    return [index for index, frame in enumerate(people.frames) if len(frame.pixel)]


def landmarks(person: np.ndarray, **fields: Callable[[int], float]) -> list[dict[str, Any]]:
    """MediaPipe's frames with further fields by frame."""
    return [
        {name: value(index) for name, value in fields.items()} | frame
        for index, frame in enumerate(mediapipe_value(person))
    ]


@pytest.mark.parametrize(
    "fields",
    [
        {"frame": lambda index: index},
        {"frame_number": lambda index: index + 1},
        {"frameIdx": lambda index: index + 101},
        {"frame": lambda index: index + 1, "timestamp_ms": lambda index: round(1000 * index / FPS)},
        {"timestamp_ms": lambda index: int(1000 * index / FPS)},
        {"timestamp": lambda index: index / FPS},
        {"time_us": lambda index: 1e6 * index / FPS, "timestamp": lambda index: 1e6 * index / FPS},
    ],
    ids=["frame", "from one", "the scene's", "both", "milliseconds", "seconds", "microseconds"],
)
def test_entries_go_to_the_frames_they_state(tmp_path: Path, fields: dict[str, Any]) -> None:
    person = moving_person(BLAZEPOSE33)
    entries = landmarks(person, **fields)
    left = [index for index in range(FRAMES) if index not in (3, 4, 8)]
    people = read(tmp_path, [entries[index] for index in left], start=101 if "frameIdx" in fields else 1)
    assert seen(people) == left and not people.notes
    for index in left:
        expected = person[index, BLAZEPOSE33.numbers, :2]
        np.testing.assert_allclose(people.frames[index].pixel[0], expected, atol=0.01)


def test_times_tell_from_which_number_frames_count(tmp_path: Path) -> None:
    entries = landmarks(
        moving_person(BLAZEPOSE33),
        frame=lambda index: index + 1,
        timestamp_ms=lambda index: 1000 * index / FPS,
    )
    assert seen(read(tmp_path, entries[2:5])) == [2, 3, 4]
    for entry in entries:
        del entry["timestamp_ms"]
    people = read(tmp_path, entries[2:5])  # nothing tells whether frame 3 is the third or the fourth
    assert len(seen(people)) == 3 and "taken to count from" in people.notes[0]


def test_what_counts_something_else_is_not_believed(tmp_path: Path) -> None:
    entries = landmarks(moving_person(BLAZEPOSE33), frame=lambda index: 7, time=lambda index: 1.7e9 + index)
    assert stated_frames(entries) == (None, None) and seen(read(tmp_path, entries)) == list(range(FRAMES))
    half = landmarks(moving_person(BLAZEPOSE33), frame=lambda index: index + 0.5)
    assert all(stated_frames(one) == (None, None) for one in (half, [], [[1], [2]]))
    beyond = landmarks(moving_person(BLAZEPOSE33), timestamp=lambda index: 5.0 + index / FPS)
    assert seen(read(tmp_path, beyond)) == list(range(FRAMES))  # one for every frame, late by the clock
    with pytest.raises(InputError, match="it must have one entry for every frame"):
        read(tmp_path, beyond[:6])


# --- OpenPose's frames in one list, with a canvas


def canvas(person: np.ndarray, unit: np.ndarray, size: tuple[int, int], **more: Any) -> list[dict[str, Any]]:
    return [
        openpose_frame([points / np.append(unit, 1.0)])
        | {"canvas_width": size[0], "canvas_height": size[1]}
        | more
        for points in person
    ]


@pytest.mark.parametrize(
    ("unit", "size"),
    [((320.0, 240.0), SIZE), ((1.0, 1.0), SIZE), ((0.5, 0.5), (640, 480)), ((320.0, 240.0), (640, 480))],
    ids=["shares", "pixels", "pixels of a larger canvas", "shares of a larger canvas"],
)
@pytest.mark.parametrize("within", [list, lambda frames: {"frames": frames}], ids=["list", "object"])
def test_a_list_of_openpose_frames(
    tmp_path: Path, unit: tuple[float, float], size: tuple[int, int], within: Callable[[Any], Any]
) -> None:
    person = moving_person(OPENPOSE25)
    frames = canvas(person, np.array(unit), size)
    frames[4]["people"] = []
    people = read(tmp_path, within([*frames[:5], None, *frames[6:]]))
    assert seen(people) == [index for index in range(FRAMES) if index not in (4, 5)]
    np.testing.assert_allclose(
        people.frames[9].pixel[0], person[9, OPENPOSE25.numbers, :2], rtol=0.0, atol=0.01
    )
    assert bool(people.notes) == (size != SIZE and unit == (0.5, 0.5))


def test_a_canvas_that_does_not_fit_is_refused(tmp_path: Path) -> None:
    frames = canvas(moving_person(OPENPOSE25), np.array([320.0, 240.0]), (320, 320))
    with pytest.raises(InputError, match=r"size is \[320, 320\].*proportions must be the same"):
        read(tmp_path, frames)
    frames[3] |= {"canvas_width": 640, "canvas_height": 640}
    with pytest.raises(InputError, match="canvas_height change"):
        read(tmp_path, frames)
    frames[3] |= {"canvas_height": "tall"}
    with pytest.raises(InputError, match=r"\[3\]: canvas_width .* must be whole pixels"):
        read(tmp_path, frames)


def test_openposes_old_key_is_read_and_another_one_is_named(tmp_path: Path) -> None:
    folder, person = tmp_path / "out", moving_person(OPENPOSE25)
    folder.mkdir()

    def write(name: str) -> None:
        for index, points in enumerate(person):
            frame = json.dumps({"people": [{name: points.ravel().tolist()}]})
            (folder / f"{index:04d}.json").write_text(frame, encoding="utf-8")

    write("pose_keypoints")
    assert seen(read_keypoints(folder, FRAMES, SIZE)) == list(range(FRAMES))
    write("face_keypoints_2d")
    with pytest.raises(InputError, match=r"people have \['face_keypoints_2d'\] and no pose_keypoints_2d"):
        read_keypoints(folder, FRAMES, SIZE)
    with pytest.raises(InputError, match="no pose_keypoints_2d"):
        read(tmp_path, [{"people": [{"face_keypoints_2d": [1, 2, 0.5]}]}] * FRAMES)


# --- Repeated results


@pytest.mark.parametrize("held", [2, 4])
def test_a_result_that_is_repeated_counts_once(tmp_path: Path, held: int) -> None:
    person = moving_person(LAYOUTS["coco17"])[np.arange(FRAMES) // held * held]
    people = read(tmp_path, coco_value(person))
    assert seen(people) == list(range(0, FRAMES, held))
    again = FRAMES - FRAMES // held
    assert people.notes == (
        f"seen.json: {again} of {FRAMES} results repeat the one before, as of a program that looks at some "
        "frames only; each counts once",
    )


def test_a_performer_who_stands_is_not_repeated_and_one_result_is_no_motion(tmp_path: Path) -> None:
    person = moving_person(LAYOUTS["coco17"])
    person[:, :, :2] = person[0, :, :2]
    person[:, 0, 2] -= 0.001 * np.arange(FRAMES)  # scores differ from picture to picture
    assert seen(read(tmp_path, coco_value(person))) == list(range(FRAMES))
    with pytest.raises(InputError, match=f"same result in each of its {FRAMES} frames.* stuck"):
        read(tmp_path, coco_value(np.repeat(person[:1], FRAMES, axis=0)))
