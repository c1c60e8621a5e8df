"""Frames in which nobody is there stay empty, and limbs that are never seen rest."""

import json
from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest
from keymark.core.api import reconstruct
from keymark.core.body.body_volume import rested
from keymark.core.body.posture import Posture
from keymark.core.detect.keypoints import Keypoints, People, SeenPeople
from keymark.core.errors import InputError
from keymark.core.markers.reading import Reading
from keymark.core.markers.region_tracks import RegionTracks
from keymark.core.prior.keyframes import Keyframe
from keymark.core.prior.registry import SHIPPED, find_libraries
from keymark.core.prior.texts import EVERY_LIBRARY
from keymark.core.progress import run
from keymark.core.review.review import review
from keymark.core.review.score import score_points
from keymark.core.take.motion import read_motion, write_motion
from keymark.core.take.presence import (
    SELDOM,
    absence_notes,
    presence,
    unseen_ends,
    unseen_limbs,
    unseen_line,
    unseen_notes,
)
from keymark.core.take.take import Take
from keymark.core.take.take_file import read_take
from keymark.core.video.album import Album

from tests._synthetic_take import BODY, write_synthetic_take

ROOT = Path(__file__).resolve().parents[3]
CASES = ROOT.parent / "shared" / "failing"
WALK = ROOT.parent / "shared" / "plain_takes" / "plain_walk"
FRAMES = 90  # at 30 a second
NAMES = ("head", "shoulder.L", "shoulder.R", "hip.L", "hip.R", "wrist.L", "wrist.R", "knee.L", "ankle.L")


@pytest.fixture
def take(tmp_path: Path) -> Take:
    """A take whose keyframes are taken away."""
    return replace(read_take(write_synthetic_take(tmp_path / "take")), keyframes=())


def seen_in(there: np.ndarray, names: tuple[str, ...] = NAMES) -> Keypoints:
    """Keypoints in the frames in which somebody is there: a column of points that walks to the right."""
    count = len(names)
    pixel = np.full((len(there), count, 2), np.nan)
    pixel[there, :, 0] = 20.0 + np.flatnonzero(there)[:, None]
    pixel[there, :, 1] = np.linspace(30.0, 100.0, count)
    score = np.where(there[:, None], 0.9, 0.0) * np.ones(count)
    return Keypoints(names, ("any",) * count, pixel, score, np.full((len(there), count, 3), np.nan))


def unmarked(album: Album | None = None) -> Reading:
    return Reading(RegionTracks.unmarked(np.arange(FRAMES) / 30.0, (160, 120)), album)


def gone(*stretches: tuple[int, int]) -> np.ndarray:
    there = np.ones(FRAMES, dtype=bool)
    for first, last in stretches:
        there[first:last] = False
    return there


def drawn(there: np.ndarray, elsewhere: np.ndarray) -> Album:
    """Pictures of a figure where `seen_in` has it, and of one at the right where it is elsewhere."""
    rng, album = np.random.default_rng(3), Album()
    room = rng.integers(90, 160, (120, 160, 1)).astype(np.uint8).repeat(3, axis=2)
    for frame in range(len(there)):
        image = room.copy()
        if there[frame]:
            cv2.rectangle(image, (14 + frame, 25), (26 + frame, 105), (20, 30, 200), -1)
        if elsewhere[frame]:
            cv2.rectangle(image, (140, 25), (152, 105), (20, 30, 200), -1)
        album.add(frame, image)
    return album


@pytest.mark.parametrize(
    ("stretches", "empty"),
    [
        ([], []),
        ([(0, 25)], [(0, 25)]),
        ([(60, 90)], [(60, 90)]),
        ([(30, 60)], [(30, 60)]),
        ([(30, 44)], []),  # bridged
        ([(0, 3), (87, 90)], []),  # a detector that finds him late
        ([(0, 10), (40, 50), (70, 90)], [(0, 10), (70, 90)]),
    ],
)
def test_who_is_not_seen_is_not_there(
    take: Take, stretches: list[tuple[int, int]], empty: list[tuple[int, int]]
) -> None:
    there = presence(take, unmarked(), seen_in(gone(*stretches)))
    np.testing.assert_array_equal(there, gone(*empty))


def test_a_clip_that_nobody_was_looked_for_in_shows_the_performer_throughout(take: Take) -> None:
    assert presence(take, unmarked(), Keypoints.none(FRAMES)).all()


@pytest.mark.parametrize(("elsewhere", "empty"), [(False, True), (True, False)])
def test_between_posed_keyframes_the_pictures_tell_absence_from_a_detector_that_fails(
    take: Take, elsewhere: bool, empty: bool
) -> None:
    seen, posture = gone((30, 60)), Posture.rest(BODY.skeleton)
    take = replace(take, keyframes=tuple(Keyframe(index, posture) for index in (0, 45, 89)))
    there = presence(take, unmarked(drawn(seen, ~seen & elsewhere)), seen_in(seen))
    np.testing.assert_array_equal(there, seen if empty else gone())
    said = absence_notes(take, there)
    assert len(said) == (2 if empty else 0)
    if empty:
        assert "frames 31 to 60" in said[0] and "2 stretches" in said[0]
        assert "keyframe 46 is posed where" in said[1]


def test_frames_before_the_first_keyframe_need_evidence(take: Take) -> None:
    keyframes = tuple(Keyframe(index, Posture.rest(BODY.skeleton)) for index in (40, 89))
    there = presence(replace(take, keyframes=keyframes), unmarked(), seen_in(gone((0, 25))))
    np.testing.assert_array_equal(there, gone((0, 25)))


def test_limbs_that_are_never_seen_are_named_unless_something_is_posed(take: Take) -> None:
    take, keypoints = replace(take, markers=()), seen_in(gone(), NAMES[:7])
    limbs = unseen_limbs(take, unmarked().tracks, keypoints, gone())
    assert limbs == ("leg.L", "leg.R")
    assert unseen_notes(limbs)[0].startswith("the legs are never seen")
    assert unseen_line(30, limbs) == "nobody is seen in 30 frames, the legs are never seen"
    assert unseen_line(0, ()) == ""
    assert unseen_limbs(take, unmarked().tracks, seen_in(gone()), gone()) == ("leg.R",)
    assert unseen_notes(("arm.L", "leg.R"))[0].startswith(
        "the left arm and the right leg are never seen and stay"
    )
    assert "is never seen and stays at rest" in unseen_notes(("leg.R",))[0]
    posed = replace(take, keyframes=(Keyframe(0, Posture.rest(BODY.skeleton)),))
    assert unseen_limbs(posed, unmarked().tracks, keypoints, gone()) == ()


def test_frames_that_a_shifted_file_says_nothing_of_are_not_empty(take: Take) -> None:
    nobody = (SeenPeople.nobody(len(NAMES)),) * FRAMES
    people = People(NAMES, "any", (160, 120), nobody, silent=tuple(range(80, FRAMES)))
    there = presence(replace(take, keypoints=(people,)), unmarked(), seen_in(gone((0, 10), (80, FRAMES))))
    np.testing.assert_array_equal(there, gone((0, 10)))
    long = replace(people, silent=tuple(range(60, FRAMES)))
    there = presence(replace(take, keypoints=(long,)), unmarked(), seen_in(gone((60, FRAMES))))
    np.testing.assert_array_equal(there, gone((60, FRAMES)))


def test_hands_and_feet_beyond_the_edge_are_named_where_their_limbs_are_seen() -> None:
    whole = seen_in(gone())
    cut = np.where((np.array(whole.names) == "ankle.L")[:, None], np.nan, whole.pixel)
    assert unseen_ends(whole, gone(), ()) == ()
    assert unseen_ends(replace(whole, pixel=cut), gone(), ()) == ("foot.L",)
    assert unseen_ends(replace(whole, pixel=cut), gone(), ("leg.L",)) == ()
    for seen, named, for_the_floor in ((0.04, 1, 1), (0.08, 1, 0), (0.12, 0, 0)):
        some = cut.copy()
        some[: round(seen * FRAMES)] = whole.pixel[: round(seen * FRAMES)]
        now = replace(whole, pixel=some)
        assert len(unseen_ends(now, gone(), ())) == named, seen
        assert len(unseen_ends(now, gone(), (), SELDOM)) == for_the_floor, seen
    (note,) = unseen_notes((), ("foot.L",))
    assert note.startswith(
        "the left foot is hardly ever seen, as beyond the picture's edge, and where it is likely"
    )
    assert "the feet are hardly ever seen" in unseen_notes((), ("foot.L", "foot.R"))[0]


def test_resting_legs_hang_down_whatever_the_pelvis_does() -> None:
    rng = np.random.default_rng(1)
    posture = Posture.from_vector(BODY.skeleton, 0.3 * rng.standard_normal((5, BODY.skeleton.dof_count)))
    points = BODY.points(BODY.pose(rested(BODY, posture, ("leg.L",))))
    at = {name: points[:, index] for index, name in enumerate(BODY.skeleton.point_names)}
    before = BODY.points(BODY.pose(posture))
    np.testing.assert_allclose((at["ankle.L"] - at["hip.L"])[:, :2], 0.0, atol=0.05)
    assert (at["ankle.L"] - at["hip.L"])[:, 2].max() < -0.7
    np.testing.assert_array_equal(at["ankle.R"], before[:, BODY.skeleton.point_names.index("ankle.R")])


def test_a_motion_is_empty_where_its_performer_is_not_there(tmp_path: Path) -> None:
    folder = write_synthetic_take(tmp_path / "take", frames=60)
    for index in range(1, 25):  # an empty room before he enters
        image = cv2.imread(str(folder / "frames" / "0030.png"))
        cv2.imwrite(str(folder / "frames" / f"{index:04d}.png"), np.full_like(image, np.median(image)))
    take = read_take(folder)
    late = replace(take, keyframes=tuple(key for key in take.keyframes if key.index >= 24))
    result = run(reconstruct(late))
    motion = result.motion
    first = motion.there.argmax()
    assert 20 <= first <= 26
    assert motion.there[first:].all()
    assert np.isnan(motion.points[:first]).all() and np.isfinite(motion.sigma_m[first:]).all()
    assert any("nobody is seen in frames 1 to" in note for note in result.notes)
    judged = run(review(late, result, np.arange(60.0)))
    assert np.isnan(judged.confidence[:first]).all() and np.isfinite(judged.confidence[first:]).all()
    assert all(weak.index >= first for weak in judged.weak_frames)
    write_motion(motion, tmp_path / "motion.json")
    content = json.loads((tmp_path / "motion.json").read_text())
    assert content["points"]["head"][first - 1] is None and content["sigma_m"]["hip.L"][0] is None
    read = read_motion(tmp_path / "motion.json")
    assert read.empty == motion.empty
    np.testing.assert_allclose(read.points, motion.points, atol=1e-6)
    np.testing.assert_allclose(read.posture.minus(motion.posture), 0.0, atol=1e-5)
    shown = read.without_absence()
    assert len(shown.time_s) == 60 - first and shown.scene_frames[0] == 1 + first
    content["posture"]["pelvis.location_x"][first] = None
    (tmp_path / "motion.json").write_text(json.dumps(content))
    with pytest.raises(InputError, match=r"posture\.pelvis\.location_x is null in other frames"):
        read_motion(tmp_path / "motion.json")


# --- Cases that were reported


def rooted(folder: Path, take: Take, points: np.ndarray, there: np.ndarray) -> float:
    """Mean distance [mm] of points (F, 13, 3) from the truth of a folder."""
    truth = json.loads((folder / "truth.json").read_text())["points"]
    true = np.stack([np.array(truth[name]) for name in BODY.skeleton.point_names], axis=1)[: len(points)]
    return score_points(np.where(there[:, None, None], points, np.nan), true, (), take.camera).mpjpe_all


@pytest.mark.slow
@pytest.mark.skipif(not CASES.is_dir(), reason="the reported cases are not beside the repository")
def test_a_performer_who_enters_late_is_as_well_known_as_without_the_frames_before() -> None:
    take = read_take(CASES / "03-enters-late", WALK / "keyframes.json")
    late = replace(take, keyframes=tuple(key for key in take.keyframes if key.index >= 33))
    for given in (take, late):
        motion = run(reconstruct(given)).motion
        assert motion.empty == tuple(range(25))
        assert rooted(WALK, take, motion.points, motion.there) < 20.0  # 815 mm in the empty frames before


@pytest.mark.slow
@pytest.mark.skipif(not CASES.is_dir(), reason="the reported cases are not beside the repository")
def test_legs_behind_a_desk_rest_and_are_not_believed() -> None:
    take = replace(read_take(CASES / "05-legs-never-seen", keyframes_required=False), keyframes=())
    result = run(reconstruct(take, libraries=find_libraries(EVERY_LIBRARY, (SHIPPED,))))
    knees = [BODY.skeleton.point_names.index(f"knee.{side}") for side in "LR"]
    assert result.motion.sigma_m[:, knees].min() > 0.2
    flexion = result.motion.posture.to_vector()[:, BODY.skeleton.dof_names.index("knee.L.flexion")]
    np.testing.assert_allclose(flexion, 0.0, atol=1e-9)
    assert any(note.startswith("the legs are never seen") for note in result.notes)
