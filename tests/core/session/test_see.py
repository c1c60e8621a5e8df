"""Evidence is held against the picture before it is believed: files and clips as people have them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import cv2
import numpy as np
import pytest
from _drawn_clip import SHAPE, SIZE, Drawn, FakeNetwork
from _synthetic_take import write_synthetic_take
from keymark.core.arrays import Array
from keymark.core.detect.keypoints import Keypoints, People, SeenPeople
from keymark.core.detect.pose_network import LAYOUT, MODEL, NAME
from keymark.core.errors import InputError
from keymark.core.markers.reading import read_clip, reading_arrays, reading_from_arrays
from keymark.core.progress import run
from keymark.core.session import see
from keymark.core.session.see import checked_keypoints as check
from keymark.core.take.conversion_settings import ConversionSettings
from keymark.core.take.description import describe
from keymark.core.take.performer_keypoints import performer_keypoints
from keymark.core.take.read_footage import read_footage
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_described, read_take
from keymark.core.video.clip import Clip

FRAMES = 40


def walker(frames: Array) -> Array:
    """(F, 2) the middle of a disc that goes across the picture, at times in frames."""
    return np.stack([60.0 + 4.0 * frames, 120.0 + 10.0 * np.sin(0.3 * frames)], axis=-1)


def clip_of(times: Array, folder: Path) -> Clip:
    """A clip that shows that walker at some times."""
    pictures = [np.zeros((SIZE[1], SIZE[0], 3), dtype=np.uint8) for _ in times]
    for picture, middle in zip(pictures, np.round(16.0 * walker(times)).astype(int), strict=True):
        cv2.circle(picture, middle.tolist(), 16 * 40, (255, 255, 255), -1, cv2.LINE_AA, 4)
    path = folder / "drawn.mp4"
    path.write_bytes(times.tobytes())
    return Clip(path, cast(Any, Drawn(pictures)))


@pytest.fixture(scope="module")
def synthetic(tmp_path_factory: pytest.TempPathFactory) -> Take:
    return read_take(write_synthetic_take(tmp_path_factory.mktemp("takes") / "take", 12, 4))


@pytest.mark.parametrize(
    ("shown", "repeated"),
    [
        (np.arange(FRAMES) // 2 * 2, range(3, FRAMES - 1, 2)),
        (np.arange(FRAMES) - (np.arange(FRAMES) % 5 == 4), range(4, FRAMES - 1, 5)),
        (np.minimum(np.arange(FRAMES), 20), ()),
        (np.where(np.arange(FRAMES) < 20, -90.0, np.arange(FRAMES)), ()),
        (20.0 * (1.0 - np.exp(-np.arange(FRAMES) / 6.0)), ()),
    ],
    ids=["15 as 30", "24 as 30", "the clip freezes at its end", "somebody appears", "somebody comes to rest"],
)
def test_a_picture_that_is_repeated_counts_once(
    shown: Array, repeated: range, synthetic: Take, tmp_path: Path
) -> None:
    noisy = np.random.default_rng(2)
    clip = clip_of(shown.astype(float), tmp_path)
    for image in cast(Any, clip.source).images:
        image[noisy.random(image.shape) < 0.05] ^= 1  # what compression leaves
    reading = run(read_clip(clip, ()))
    assert reading.frame_findings.repeated == tuple(repeated)
    assert reading.album is not None
    left_out = {*repeated, *reading.frame_findings.blank}
    assert {index for index in range(FRAMES) if index not in reading.album} == left_out
    assert reading_from_arrays(reading_arrays(reading)).frame_findings == reading.frame_findings
    notes = [note for note in reading.frame_findings.notes(1) if "repeat" in note]
    assert bool(notes) == bool(repeated)
    if repeated:
        assert notes[0].startswith(f"{len(repeated)} of {FRAMES} pictures repeat the one before (")
    people = detected(walker(shown.astype(float)))
    take = replace(synthetic, keypoints=(people,))
    checked = run(check(take, reading))
    empty = [index for index, frame in enumerate(checked[0].frames) if not len(frame.pixel)]
    assert empty == list(repeated)


def detected(middles: Array, by_hand: bool = False) -> People:
    score, hint = np.full((1, len(SHAPE)), 0.9), np.zeros((1, len(SHAPE), 3))
    frames = tuple(SeenPeople((middle + 40.0 * SHAPE)[None], score, hint) for middle in middles)
    return People(LAYOUT.names, "detector", SIZE, frames, "seen.json", by_hand)


# --- Keypoints that are not of this picture, as files on disk


PLAIN_WALK_FRAMES, JUMPED = 86, range(30, 50)


@pytest.fixture(scope="module")
def plain_walk(repository: Path) -> Path:
    folder = repository.parent / "shared" / "plain_takes" / "plain_walk"
    if not folder.is_dir():
        pytest.skip("no shared/plain_takes beside the repository")
    return folder


@pytest.fixture
def failing(repository: Path, plain_walk: Path) -> Callable[[str], Path]:
    """A function from a name to a file among those that fail, which lie beside the repository."""

    def file(name: str) -> Path:
        path = repository.parent / "shared" / "failing" / name
        if not path.exists():
            pytest.skip(f"no {name} in shared/failing")
        return path

    return file


def unposed(folder: Path, keypoints: Path) -> Take:
    settings = ConversionSettings(keypoints=(keypoints,))
    return read_described(
        describe(folder), None, keyframes_required=False, fewest_keyframes=0, settings=settings
    )


def pixels(people: People) -> Array:
    """(F, N, 2) of one person, NaN where nobody is seen."""
    rows = [frame.pixel[0] if len(frame.pixel) else np.full((len(people.names), 2), np.nan)
            for frame in people.frames]  # fmt: skip
    return np.array(rows)


def apart(people: People, other: People) -> float:
    """Median distance of two detectors' points [px] where both see them."""
    names = [name for name in people.names if name in other.names]
    one, two = (pixels(each)[:, [each.names.index(name) for name in names]] for each in (people, other))
    return float(np.nanmedian(np.linalg.norm(one - two, axis=-1)))


@pytest.fixture(scope="module")
def own(plain_walk: Path) -> People:
    return unposed(plain_walk, plain_walk / "keypoints_mediapipe.json").keypoints[0]


def needs_network() -> None:
    if not MODEL.is_file():
        pytest.skip("the network is not here; tools/fetch_model.py brings it")


def test_keypoints_of_half_the_size_are_scaled(
    failing: Callable[[str], Path], plain_walk: Path, own: People
) -> None:
    needs_network()
    take = unposed(plain_walk, failing("01-keypoints-of-another-size/half_size.json"))
    reading = run(read_footage(replace(take, contours=False)))
    assert apart(take.keypoints[0], own) > 40.0
    (people,) = run(check(take, reading))
    assert apart(people, own) < 0.5
    assert any("160 x 120" in note for note in people.notes)


@pytest.mark.parametrize(("name", "missing"), [("two_missing", (20, 21)), ("enters_late", range(15))])
def test_frame_numbers_in_a_file_are_believed(
    failing: Callable[[str], Path], plain_walk: Path, own: People, name: str, missing: tuple[int, ...]
) -> None:
    (people,) = unposed(plain_walk, failing(f"02-frame-numbers-ignored/{name}.json")).keypoints
    assert [index for index, frame in enumerate(people.frames) if not len(frame.pixel)] == list(missing)
    assert apart(people, own) < 0.1 and not people.notes


@pytest.mark.parametrize("name", ["normalized", "pixels"])
def test_a_stated_canvas_is_used(
    failing: Callable[[str], Path], plain_walk: Path, own: People, name: str
) -> None:
    (people,) = unposed(plain_walk, failing(f"07-stated-canvas/{name}.json")).keypoints
    assert people.seen_frames == PLAIN_WALK_FRAMES and apart(people, own) < 0.1


def test_results_that_are_held_count_once(failing: Callable[[str], Path], plain_walk: Path) -> None:
    (people,) = unposed(plain_walk, failing("08-held-detections/every_fourth_held.json")).keypoints
    assert [index for index, frame in enumerate(people.frames) if len(frame.pixel)] == list(range(0, 86, 4))
    assert "64 of 86 results repeat the one before" in people.notes[0]


def test_pictures_that_are_repeated_are_found(failing: Callable[[str], Path]) -> None:
    take = read_take(failing("09-repeated-frames"), whole=True)
    reading = run(read_footage(replace(take, keyframes=())))
    assert reading.frame_findings.repeated == tuple(range(4, 86, 5))
    assert any(note.startswith("17 of 86 pictures repeat") for note in reading.notes)


def test_a_jump_to_a_passer_by_is_left_out(failing: Callable[[str], Path], plain_walk: Path) -> None:
    needs_network()
    take = unposed(plain_walk, failing("10-another-person-in-between/passer_by.json"))
    reading = run(read_footage(replace(take, contours=False)))
    found: Keypoints = performer_keypoints(replace(take, keypoints=run(check(take, reading))), reading.tracks)
    np.testing.assert_array_equal(np.flatnonzero(~found.seen.any(axis=1)), JUMPED)
    assert any("the 20 frames that show him are left out" in note for note in found.notes)


def test_points_by_hand_and_those_just_found_need_no_network(
    synthetic: Take, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    network = FakeNetwork()
    monkeypatch.setattr(see, "_network", lambda: network)
    reading = run(read_clip(clip_of(np.arange(FRAMES, dtype=float), tmp_path), ()))
    back = walker(np.arange(FRAMES)[::-1])
    for take in (
        replace(synthetic, keyframes=(), keypoints=(detected(back, by_hand=True),)),
        replace(synthetic, keyframes=(), keypoints=(replace(detected(back), source=NAME, file=""),)),
    ):
        assert run(check(take, reading)) == take.keypoints
    assert network.looks == 0
    away = replace(synthetic, keyframes=(), keypoints=(detected(back),))
    with pytest.raises(InputError, match=r"seen\.json: .* must be of this clip"):
        run(check(away, reading))
    assert network.looks > 0
    posed = replace(away, keyframes=synthetic.keyframes)  # which tell by themselves what is of another clip
    assert run(check(posed, reading)) == posed.keypoints
    (shifted,) = run(check(replace(posed, keypoints=(detected(walker(np.arange(FRAMES) - 4.0)),)), reading))
    np.testing.assert_allclose(pixels(shifted)[:36], pixels(detected(walker(np.arange(36.0)))))
    assert "about 4 frames before: it is late" in shifted.notes[0]


def test_without_the_network_files_are_believed(
    synthetic: Take, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(see, "_network", lambda: None)
    reading = run(read_clip(clip_of(np.arange(FRAMES, dtype=float), tmp_path), ()))
    take = replace(synthetic, keyframes=(), keypoints=(detected(0.5 * walker(np.arange(FRAMES))),))
    assert run(check(take, reading)) == take.keypoints
