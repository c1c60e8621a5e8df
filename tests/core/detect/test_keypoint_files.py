"""Files of keypoints: every format gives the same people, and what does not fit the clip is said."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from _keypoints import (
    BLAZEPOSE33,
    BODY25,
    COCO17,
    FRAMES,
    HALPE26,
    SIZE,
    coco_value,
    mediapipe_value,
    mmpose_value,
    moving_person,
    openpose_frame,
    own_value,
    write,
    write_openpose,
)
from keymark.core.arrays import Array
from keymark.core.detect.keypoint_file import read_keypoints, write_keypoints
from keymark.core.detect.keypoints import HAND_NUMBERS, People, SeenPeople
from keymark.core.detect.layouts import Layout
from keymark.core.errors import InputError


def read(path: Path, frames: int | None = FRAMES, size: tuple[int, int] = SIZE, **more: Any) -> People:
    return read_keypoints(path, frames, size, **more)


def assert_shows(people: People, person: Array, layout: Layout, frames: list[int] | None = None) -> None:
    """One person is seen in these frames, by default in all, and nobody in the others."""
    assert people.names == layout.names
    shown = [index for index, frame in enumerate(people.frames) if len(frame.pixel)]
    assert shown == (list(range(len(person))) if frames is None else frames)
    for index in shown:
        np.testing.assert_allclose(
            people.frames[index].pixel[0], person[index][layout.numbers, :2], atol=1e-9
        )
        np.testing.assert_allclose(people.frames[index].score[0], person[index][layout.numbers, 2], atol=1e-9)


@pytest.mark.parametrize("layout", [COCO17, BODY25, HALPE26])
@pytest.mark.parametrize("first", [0, 1, 1001])
def test_openpose_folder(tmp_path: Path, layout: Layout, first: int) -> None:
    person = moving_person(layout)
    people = read(write_openpose(tmp_path / "json", person, first))
    assert_shows(people, person, layout)
    assert (people.source, people.notes, people.by_hand) == ("json", (), False)


def test_openpose_folder_with_holes(tmp_path: Path) -> None:
    person = moving_person(BODY25)
    people = read(write_openpose(tmp_path / "json", person, 0, holes=(3, 4, 11)))
    assert_shows(people, person, BODY25, [0, 1, 2, 5, 6, 7, 8, 9, 10])
    (note,) = people.notes
    assert note.startswith("json: lacks 3 of 12 frames")  # the same wherever the folder lies


def test_numbers_that_do_not_fit_the_clip_are_refused(tmp_path: Path) -> None:
    person = moving_person(BODY25)
    folder = write_openpose(tmp_path / "json", person, 7)
    with pytest.raises(InputError, match="numbered 7 to 18; the clip has 13"):
        read(folder, 13)
    with pytest.raises(InputError, match="ends with frame 18"):
        read(folder, 30)
    with pytest.raises(InputError, match=r"before the clip's last.*one for every 2"):
        read(write_openpose(tmp_path / "half", person), 24)
    with pytest.raises(InputError, match="must begin with 0, 1 or"):
        read(folder, None)
    assert len(read(write_openpose(tmp_path / "one", person, 1), None).frames) == FRAMES


def test_a_few_frames_more_or_less_are_noted(tmp_path: Path) -> None:
    person = moving_person(BODY25)
    folder = write_openpose(tmp_path / "json", person)
    longer, shorter = read(folder, FRAMES - 1), read(folder, FRAMES + 2)
    assert_shows(longer, person[:-1], BODY25)
    assert "goes on to frame 11" in longer.notes[0]
    assert_shows(shorter, person, BODY25, list(range(FRAMES)))
    assert len(shorter.frames) == FRAMES + 2 and "lacks 2" in shorter.notes[0]


def test_hands_of_openpose_follow_the_body(tmp_path: Path) -> None:
    person, hand = moving_person(BODY25), np.round(moving_person(BODY25, seed=1)[:, :21], 3)
    folder = write_openpose(tmp_path / "json", person)
    for index in (4, 5):
        value = openpose_frame([person[index]])
        value["people"][0]["hand_right_keypoints_2d"] = hand[index].ravel().tolist()
        value["people"][0]["hand_left_keypoints_2d"] = []
        write(folder / f"clip_{index:012d}_keypoints.json", value)
    people = read(folder)
    assert people.names[:25] == BODY25.names
    assert people.names[25:] == tuple(
        f"{name}.{side}" for side in "LR" for name in ("thumb", "index", "pinky")
    )
    np.testing.assert_array_equal(people.frames[4].pixel[0, 28:], hand[4, [2, 5, 17], :2])
    assert np.isnan(people.frames[4].pixel[0, 25:28]).all() and np.isnan(people.frames[3].pixel[0, 25:]).all()
    np.testing.assert_array_equal(people.frames[3].pixel[0, :25], person[3, :, :2])


def test_mmpose_of_an_image_sequence(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    for index, entry in enumerate(mmpose_value(person)["instance_info"]):
        write(tmp_path / f"img_{index + 1:04d}.json", [] if index == 2 else entry["instances"])
    assert_shows(read(tmp_path), person, COCO17, [0, 1, *range(3, FRAMES)])


@pytest.mark.parametrize("as_list", [False, True])
def test_mmpose(tmp_path: Path, as_list: bool) -> None:
    person = moving_person(HALPE26)
    value: Any = mmpose_value(person)
    people = read(write(tmp_path / "results.json", value["instance_info"] if as_list else value))
    assert_shows(people, person, HALPE26)
    assert people.source == "results.json"


@pytest.mark.parametrize("names", ["{}.jpg", "clip_{}", "{}"])
def test_coco(tmp_path: Path, names: str) -> None:
    person = moving_person(COCO17)
    value = coco_value(person, names)
    if names == "{}":
        for entry in value:
            entry["image_id"] = int(entry["image_id"])
    del value[4]
    people = read(write(tmp_path / "results.json", value))
    assert_shows(people, person, COCO17, [0, 1, 2, 3, 5, 6, 7, 8, 9, 10, 11])


@pytest.mark.parametrize("form", ["objects", "lists", "messages", "people", "frames", "pixels"])
def test_mediapipe(tmp_path: Path, form: str) -> None:
    person = moving_person(BLAZEPOSE33)
    value: Any = mediapipe_value(person, (1, 1) if form == "pixels" else SIZE)
    value[2] = None if form in ("lists", "frames") else {"landmarks": []}
    if form == "lists":
        value = [frame and frame["landmarks"] for frame in value]
    elif form == "messages":
        value = [{"pose_landmarks": {"landmark": frame["landmarks"]}} for frame in value]
    elif form == "people":
        names = {"landmarks": "landmarks", "worldLandmarks": "world_landmarks"}
        value = [{names[name]: [one] if one else [] for name, one in frame.items()} for frame in value]
    elif form == "frames":
        value = {"frames": value}
    people = read(write(tmp_path / "pose.json", value))
    assert_shows(people, person, BLAZEPOSE33, [0, 1, *range(3, FRAMES)])
    hint = people.frames[5].hint_m[0]
    if form in ("lists", "messages"):
        assert np.isnan(hint).all()
    else:
        x, y, _ = person[5][BLAZEPOSE33.numbers].T
        np.testing.assert_allclose(hint, np.stack([x / 100 - 1, y / 100 - 1, np.full(len(x), 0.2)], 1))


def test_own_file_is_read_back(tmp_path: Path) -> None:
    generator = np.random.default_rng(3)
    frames = []
    for count in (1, 0, 3, 2, 0):
        pixel = np.round(generator.uniform(1.0, 239.0, (count, 2, 2)), 3)
        score = np.round(generator.uniform(0.1, 1.0, (count, 2)), 4)
        hint = np.round(generator.normal(size=(count, 2, 3)), 4)
        pixel[:1, 1], score[:1, 1], hint[:1, 1] = np.nan, 0.0, np.nan
        hint[1:2] = np.nan
        face = np.round(generator.uniform(0.0, 1.0, (count, 6)), 4)
        face[2:3] = np.nan
        hands = np.round(generator.uniform(0.0, 1.0, (count, 2, HAND_NUMBERS)), 4)
        hands[1:2, 0] = hands[2:3] = np.nan
        frames.append(SeenPeople(pixel, score, hint, *((face, hands) if count else (None, None))))
    people = People(("head", "heel.L"), "a detector", SIZE, tuple(frames), by_hand=True)
    write_keypoints(tmp_path / "keypoints.json", people, 7, 25.0)
    again = read(tmp_path / "keypoints.json", 5, fps=25.0, frame_start=7)
    assert (again.names, again.source, again.size, again.by_hand) == (people.names, "a detector", SIZE, True)
    assert again.notes == ()
    for one, other in zip(people.frames, again.frames, strict=True):
        for name in ("pixel", "score", "hint_m", "face", "hands"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


def test_one_person_is_written_as_the_plain_form(tmp_path: Path) -> None:
    frame = SeenPeople(np.array([[[5.0, 6.0]]]), np.array([[1e-7]]), np.full((1, 1, 3), np.nan))
    write_keypoints(tmp_path / "k.json", People(("head",), "x", SIZE, (frame,) * 2), 1)
    text = (tmp_path / "k.json").read_text(encoding="utf-8")
    assert '"frames":[[[5.0,6.0,0.0001]]' in text and "world" not in text
    assert read(tmp_path / "k.json", 2).frames[1].pixel[0].tolist() == [[5.0, 6.0]]


def test_pixels_of_the_stored_picture_are_scaled_to_square_ones(tmp_path: Path) -> None:
    person, stored = moving_person(COCO17), (SIZE[0] * 3 // 4, SIZE[1])
    path = write(tmp_path / "own.json", {**own_value(person * [0.75, 1.0, 1.0]), "size": list(stored)})
    people = read(path, stored_size=stored)
    assert_shows(people, person, COCO17)
    assert f"found in pictures of {stored[0]} x {stored[1]}; scaled" in people.notes[0]
    with pytest.raises(InputError, match="proportions"):
        read(path)


def test_pixels_of_a_smaller_picture_are_scaled(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    path = write(tmp_path / "own.json", own_value(person))
    twice = read(path, FRAMES, (640, 480))
    assert_shows(twice, person * [2.0, 2.0, 1.0], COCO17)
    assert "scaled to the clip's 640 x 480" in twice.notes[0] and twice.size == (640, 480)
    with pytest.raises(InputError, match="proportions must be the same"):
        read(path, FRAMES, (640, 360))
    with pytest.raises(InputError, match="was turned"):
        read(path, FRAMES, (240, 320))


def test_points_not_seen(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    person[0, 3] = [0.0, 0.0, 0.7]
    person[0, 4, 2] = 0.0
    person[0, 5, 0] = -3.0
    person[1] = 0.0
    people = read(write(tmp_path / "own.json", own_value(person)))
    first = people.frames[0]
    assert np.isnan(first.pixel[0, [3, 4, 5]]).all() and not first.score[0, [3, 4, 5]].any()
    assert np.isfinite(first.pixel[0, [0, 1, 2, *range(6, 17)]]).all()
    assert len(people.frames[1].pixel) == 0 and len(people.frames[2].pixel) == 1


def test_nan_of_other_programs_is_not_seen(tmp_path: Path) -> None:
    person = moving_person(HALPE26)
    person[2] = np.nan
    person[3, 0, :2] = np.nan
    people = read(write_openpose(tmp_path / "json", person))
    assert len(people.frames[2].pixel) == 0
    assert np.isnan(people.frames[3].pixel[0, 0]).all() and people.frames[3].score[0, 0] == 0.0
    with pytest.raises(InputError, match="null or NaN"):
        read(write(tmp_path / "own.json", own_value(person, "halpe26")))


@pytest.mark.parametrize(
    ("change", "word"),
    [
        (lambda s: 12.0 * s - 9.0, "logits"),
        (lambda s: 9.0 * s, "count as certain"),
        (lambda s: 0.0 * s, "no scores"),
    ],
)
def test_scores_become_confidences(tmp_path: Path, change: Any, word: str) -> None:
    person = moving_person(COCO17)
    before = person[:, :, 2].copy()
    person[:, :, 2] = change(before)
    person[0, 0, 2] = person[:, :, 2].max()
    people = read(write(tmp_path / "own.json", own_value(person)))
    after = np.concatenate([frame.score for frame in people.frames])
    assert after.min() > 0.0 and after.max() <= 1.0 and len(people.notes) == 1 and word in people.notes[0]
    if word != "no scores":
        order = np.argsort(before[3])
        assert np.all(np.diff(after[3][order]) >= 0.0) and after[3].min() < 0.9


def test_one_high_score_sets_no_scale(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    person[0, 0, 2] = 500.0
    people = read(write(tmp_path / "own.json", own_value(person)))
    np.testing.assert_allclose(people.frames[5].score[0], person[5, :, 2])


def test_negative_scores_beside_probabilities_are_not_seen(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    person[:, 3, 2] = -1.0
    people = read(write(tmp_path / "own.json", own_value(person)))
    assert people.notes == () and np.isnan(people.frames[0].pixel[0, 3]).all()
    np.testing.assert_allclose(people.frames[0].score[0, 4], person[0, 4, 2])


def test_frame_rate_and_start_of_the_file(tmp_path: Path) -> None:
    person = moving_person(COCO17)
    path = write(tmp_path / "own.json", own_value(person) | {"fps": 60.0})
    assert any("60 frames per second" in note for note in read(path, fps=30.0).notes)
    assert read(path, fps=59.94).notes == ()
    assert any(
        "frame_start is 1, that of the clip is 101" in note for note in read(path, frame_start=101).notes
    )
    with pytest.raises(InputError, match="made at 60 frames per second"):
        read(path, 6, fps=30.0)
    with pytest.raises(InputError, match="begin with 101"):
        read(path, 13, frame_start=101)


def refused(path: Path, words: str) -> None:
    """A file is refused in a sentence that names it and what would be valid."""
    with pytest.raises(InputError, match=words) as caught:
        read(path)
    text = str(caught.value)
    assert str(path) in text and len(text.splitlines()) == 1
    assert any(valid in text for valid in ("must", "at most", "no valid JSON", "layouts that are read"))


PERSON, BODY = moving_person(COCO17), moving_person(BODY25)
OWN = own_value(PERSON)
IN_SPACE = {"frame_id": 0, "instances": [{"keypoints": [[1, 2, 3]] * 17}]}
UNUSABLE: dict[str, Any] = {
    "one frame of OpenPose, whose folder": openpose_frame([BODY[0]]),
    "one picture of MMPose": mmpose_value(PERSON)["instance_info"][0]["instances"],
    "the fields .'poses'., which no known format has": {"poses": []},
    "it must be Keymark's own file": "keypoints",
    "is empty; it must be": [],
    "nobody is seen in any of its 12 frames": OWN | {"frames": [None] * FRAMES},
    "no point has a score above 0|nobody": OWN | {"frames": (PERSON * 0.0).tolist()},
    "frames has 0 of them; it must be a list of 1 to 1000000 entries, one a frame": OWN | {"frames": []},
    "must be pixels of the clip": OWN | {"frames": (PERSON / [320.0, 240.0, 1.0]).tolist()},
    "outside the clip's picture": own_value(PERSON * [6.0, 6.0, 1.0]),
    "points in space": {"instance_info": [IN_SPACE]},
    "has 6 frames, the clip 12.*one for every 2": OWN | {"frames": PERSON[::2].tolist()},
    "a number beyond 1e": OWN | {"frames": (PERSON * 1e8).tolist()},
}


@pytest.mark.parametrize("words", UNUSABLE)
def test_unusable_files_are_refused_with_a_sentence(tmp_path: Path, words: str) -> None:
    refused(write(tmp_path / "x.json", UNUSABLE[words]), words)


def test_a_truncated_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "x.json").write_text('{"layout": "coco17", "frames": [[[1, 2', encoding="utf-8")
    refused(tmp_path / "x.json", "no valid JSON")


def without_numbers(file: Path) -> None:
    """Rename all files of the folder."""
    for one in list(file.parent.iterdir()):
        one.rename(one.with_name("x" + "y" * int(one.name[5:17]) + ".json"))


def linked(file: Path) -> None:
    """Replace a file by a link that leads outside."""
    outside = file.rename(file.parents[1] / "outside.json")
    file.symlink_to(outside)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda file: file.write_text('{"people": ['), "000003_keypoints.json.*no valid JSON"),
        (lambda file: write(file.with_name("other_3.json"), openpose_frame([])), "the same number"),
        (without_numbers, "ends in a number"),
        (linked, "leads by a link"),
        (lambda file: write(file, openpose_frame([np.ones((20, 3))])), "has 20 points; those before have 25"),
        (lambda file: write(file, openpose_frame([np.ones((17, 3))])), "all must be alike"),
        (lambda file: write(file, openpose_frame([BODY[0]] * 101)), "has 101 people; at most 100"),
    ],
)
def test_unusable_folders_are_refused_with_a_sentence(tmp_path: Path, change: Any, words: str) -> None:
    folder = write_openpose(tmp_path / "json", BODY)
    change(folder / "clip_000000000003_keypoints.json")
    refused(folder, words)
