"""A clip that is cut: the cuts are found, one shot is animated, and one sentence says so."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints, People, SeenPeople
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading, reading_arrays, reading_from_arrays
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe
from keymark.core.take.presence import absence_notes, of_one_shot, presence, shot_of, within_shot
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.core.video.album import Album
from keymark.core.video.clip import Clip
from keymark.core.video.frame_checks import FrameChecks, FrameFindings

from tests._synthetic_take import BODY, SIZE, write_synthetic_take

CUT = Path(__file__).resolve().parents[4] / "shared" / "failing" / "turn4_cut_to_another_camera"
FRAMES, POINTS = 90, ("head", "hip.L", "hip.R")
CUTS = (20, 60)


def room(seed: int) -> np.ndarray:
    """A picture (120, 160, 3) of a room of its own."""
    rng = np.random.default_rng(seed)
    return cv2.resize(rng.integers(20, 230, (6, 8, 3)).astype(np.uint8), SIZE, interpolation=cv2.INTER_CUBIC)


ONE, OTHER = room(1), room(2)
LIT = cv2.convertScaleAbs(ONE, alpha=0.5)
CLOSER = cv2.resize(ONE[20:100, 27:133], SIZE)


def found_in(pictures: list[np.ndarray]) -> FrameFindings:
    """What the checks find where a figure walks through the pictures."""
    checks = FrameChecks()
    for index, picture in enumerate(pictures):
        image = picture.copy()
        if not picture.any():
            checks.add(index, image)
            continue
        cv2.rectangle(
            image,
            (10 + 2 * index, 30),
            (22 + 2 * index, 110),
            (10, 15, 100) if picture is LIT else (20, 30, 200),
            -1,
        )
        checks.add(index, image)
    return checks.findings()


@pytest.mark.parametrize(
    ("pictures", "cuts", "changes"),
    [
        ([ONE] * 40, (), ()),
        ([ONE] * 20 + [OTHER] * 20, (20,), ()),
        ([ONE] * 12 + [OTHER] * 12 + [ONE] * 12, (12, 24), ()),
        ([ONE] * 20 + [CLOSER] * 20, (20,), ()),
        ([ONE] * 20 + [LIT] * 20, (), (20,)),
        ([ONE] * 20 + [OTHER] * 2 + [ONE] * 20, (), (20, 22)),
        ([np.roll(ONE, 8 * index, axis=1) for index in range(40)], (), ()),
        ([ONE] * 15 + [np.zeros_like(ONE)] * 5 + [OTHER] * 15, (20,), ()),
    ],
    ids=["one shot", "cut", "cut there and back", "closer", "light", "flash", "pan", "through black"],
)
def test_a_cut_is_another_picture_that_stays(
    pictures: list[np.ndarray], cuts: tuple[int, ...], changes: tuple[int, ...]
) -> None:
    found = found_in(pictures)
    assert (found.cuts, found.changes) == (cuts, changes)


def test_the_cut_of_an_edited_clip_is_found() -> None:
    if not CUT.exists():
        pytest.skip("no edited clip in shared/failing")
    checks = FrameChecks()
    for index, _, image in Clip.open(CUT / "hardcut2.mp4").frames():
        checks.add(index, image)
    assert checks.findings().notes(1) == ("the clip is cut at frame 46",)


@pytest.fixture
def take(tmp_path: Path) -> Take:
    """Somebody in frames 2 to 29 and 31 to 85, and nothing posed."""
    there = [2 <= index < 86 and index != 30 for index in range(FRAMES)]
    seen = SeenPeople(np.full((1, 3, 2), 50.0), np.ones((1, 3)), np.full((1, 3, 3), np.nan))
    frames = tuple(seen if one else SeenPeople.nobody(3) for one in there)
    drawn = read_take(write_synthetic_take(tmp_path / "take"))
    return replace(drawn, markers=(), keyframes=(), keypoints=(People(POINTS, "any", SIZE, frames),))


def cut_reading() -> Reading:
    album = Album()
    for index in range(FRAMES):
        album.add(index, ONE)
    findings = FrameFindings(FRAMES, cuts=CUTS)
    tracks = RegionTracks.unmarked(np.arange(FRAMES) / 30.0, SIZE)
    return Reading(tracks, album, notes=(*findings.notes(1), "another note"), frame_findings=findings)


@pytest.mark.parametrize(
    ("posed", "shot"), [((), (20, 60)), ((5,), (0, 20)), ((70, 89), (60, 90)), ((5, 70), None)]
)
def test_the_posed_shot_or_the_longest_seen_is_animated(
    take: Take, posed: tuple[int, ...], shot: tuple[int, int] | None
) -> None:
    rest = Posture.rest(BODY.skeleton)
    take = replace(take, keyframes=tuple(Keyframe(index, rest) for index in posed))
    assert shot_of(take, cut_reading()) == shot


def test_nothing_is_seen_outside_of_the_shot_and_one_sentence_says_so(take: Take) -> None:
    reading = reading_from_arrays(reading_arrays(cut_reading()))
    (people,), one = (own := of_one_shot(take, reading))[0].keypoints, own[1]
    seen = [index for index, frame in enumerate(people.frames) if len(frame.pixel)]
    assert seen == [*range(20, 30), *range(31, 60)]
    assert one.album is not None and [i for i in range(FRAMES) if i in one.album] == [*range(20, 60)]
    assert one.notes == (
        "the clip is cut at frames 21, 61; the motion is that of frames 21 to 60 and empty elsewhere: "
        "--frames names another shot",
        "another note",
    )
    there = presence(take, one, Keypoints.none(FRAMES))
    np.testing.assert_array_equal(there, within_shot(one))
    assert np.flatnonzero(there).tolist() == [*range(20, 60)]
    assert absence_notes(take, there, within_shot(one)) == ()


def test_frames_that_are_named_are_animated(take: Take) -> None:
    rest = Posture.rest(BODY.skeleton)
    take = replace(take, keyframes=(Keyframe(5, rest), Keyframe(70, rest)))
    own, one = of_one_shot(take, cut_reading(), (65, 80))
    assert [key.index for key in own.keyframes] == [70] and one.shot == (64, 80)
    assert one.notes[0] == "the motion is that of frames 65 to 80 and empty elsewhere"
    assert not [note for note in one.notes if "cut" in note]
    for frames, cut in (((15, 40), "frame 21"), ((20, 61), "frames 21, 61"), ((21, 60), "")):
        note = of_one_shot(take, cut_reading(), frames)[1].notes[0]
        assert (f"but the clip is cut at {cut}, within them" in note) if cut else "cut" not in note, note
    with pytest.raises(InputError, match=r"frames 65 to 91 are not all in .*, whose frames are 1 to 90"):
        of_one_shot(take, cut_reading(), (65, 91))


def test_a_clip_of_one_shot_is_left_as_it_is(take: Take) -> None:
    reading = replace(cut_reading(), frame_findings=FrameFindings(FRAMES))
    assert of_one_shot(take, reading) == (take, reading) and within_shot(reading).all()
