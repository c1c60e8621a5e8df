"""A person's session in a Blender with a screen, and its motion held against the command line's."""

import json
import shutil
from pathlib import Path

import numpy as np
import pytest
from _profile_take import profile_take
from _synthetic_take import PANEL, panelled_take
from installed_blender import Blender
from keymark.core.body.human import HUMAN
from keymark.core.detect.layouts import LAYOUTS
from keymark.core.review.score import Score, read_truth, score_points
from keymark.core.take.take_file import read_take

pytestmark = pytest.mark.ui

UNPOSED_MM = 200.0  # Error with hips aligned beyond which a motion is no likeness of the performer's
SCREEN = ("1600", "1000")
STEPS = (
    *("empty", "footage", "markers", "actor", "keyframes", "reconstructed", "review", "finish"),
    *("drag_joints", "dragging", "dragged", "from_the_side", "corrected", "character", "retargeted"),
)
"""Each leaves at least one picture of this name."""
PLAIN_STEPS = ("keypoints", "clicking", "clicked", "tracks", "fitted_pose", "reconstructed", "review")
CHOOSING_STEPS = ("matched", "posed_all", "from_the_side")
HURRIED_STEPS = ("posed_all", "decided", "corrected", "unposed")
FIRST_STEPS = (
    *("start", "panel", "examples", "example", "reconstructed", "played", "review"),
    *("enable_rigify", "character", "retargeted", "taken_back", "plain_clothes"),
)
FIRST_CLICKS, FIRST_KEYS = 6, 6
"""Tab, example (button and entry), Reconstruct, Add Rigify Human, Retarget; N, Space four times, Enter."""
ANIMATE_STEPS = ("panel", "file_browser", "mistaken", "running", "animated", "played", "put_right")
ANIMATE_MOST = 2, 2
"""Clicks and keys: tab, Animate; N, Enter. Choosing a file and entering the height take three clicks more."""
CORRECTED_MOST = 10, 6
"""With a joint dragged in two poses, and the motion made and given to the character anew; played once."""
MOST_CLICKS = 40
"""From the clip to the motion: a button, five sleeves, a few buttons more, and four doubtful keyframes."""
STATES = (
    "empty",
    "clip",
    "performer",
    "poses",
    "candidate",
    "correcting",
    "motion",
    "character",
    "export",
    "two_characters",
    "read_back",
)
SHELF_STEPS = ("libraries", "assets")
MARKER_STEPS = ("asked", "masks_while_picking", "one_row", "warned", "brushing", "brushed", "still_area")
HARM_MM = 4.0  # What feet that rest elsewhere by a few pixels make of a motion, twice
CLICKS_MM = 4.0  # What a clicked point and a track in a single frame may change
AGREEMENT_MM = 1.5
"""The eyedropper's colors are a level or two off the take's, and the armature's bones are float32."""
PATIENCE_S = 3000.0


def run_script(
    blender: Blender,
    name: str,
    pictured: tuple[str, ...],
    take: Path | None,
    folder: Path,
    *words: str,
    screen: tuple[str, str] = SCREEN,
) -> None:
    """Run a session's script in a Blender with a screen; it must go through, and leave pictures."""
    script = Path(__file__).with_name(name)
    done = blender.run(
        *("--factory-startup", "--addons", "bl_ext.user_default.keymark", "--enable-event-simulate"),
        *("--window-geometry", "0", "0", *screen, "--no-window-focus", "--python-exit-code", "1"),
        *("--python", script, "--"),
        *([] if take is None else [take]),
        folder,
        *words,
        patience_s=PATIENCE_S,
    )
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-4000:]
    assert "Traceback" not in done.stdout + done.stderr, done.stdout[-4000:] + done.stderr[-4000:]
    assert "The script went through" in done.stdout
    pictures = " ".join(file.name for file in folder.glob("*.png"))
    assert [step for step in pictured if f"_{step}" not in pictures] == []


def test_the_first_minutes(blender_on_screen: Blender, repository: Path) -> None:
    folder = repository / "build" / "screenshots" / "first"
    run_script(blender_on_screen, "first_session.py", FIRST_STEPS, None, folder)
    clicks, _, _, keys = (folder / "summary.txt").read_text(encoding="utf-8").split()[:4]
    assert int(clicks) <= FIRST_CLICKS and int(keys) <= FIRST_KEYS


def test_a_clip_and_a_height_lead_to_a_moving_character(
    blender_on_screen: Blender, repository: Path, tmp_path: Path
) -> None:
    example = repository / "presets" / "demo" / "greeting"
    clip = Path(shutil.copy(example / "clip.mp4", tmp_path / "hello.mp4"))
    shutil.copy(example / "keypoints.json", tmp_path / "hello.keypoints.json")
    folder = repository / "build" / "screenshots" / "animate"
    run_script(blender_on_screen, "animate_session.py", ANIMATE_STEPS, clip, folder)
    for file, most in (("summary.txt", ANIMATE_MOST), ("corrections.txt", CORRECTED_MOST)):
        clicks, _, _, keys = (folder / file).read_text(encoding="utf-8").split()[:4]
        assert int(clicks) <= most[0] and int(keys) <= most[1], file


def test_a_network_of_ones_own_is_chosen_and_followed(
    blender_on_screen: Blender, repository: Path, tmp_path: Path
) -> None:
    networks = pytest.importorskip("_networks", reason="onnx", exc_type=ImportError)
    clip = networks.dotted_performer(repository / "presets" / "demo" / "greeting", tmp_path / "dots.avi")
    network = networks.simcc(tmp_path / "body.onnx", 17, LAYOUTS["coco17"].numbers)
    folder = repository / "build" / "screenshots" / "network"
    run_script(blender_on_screen, "network_session.py", ("dialog", "animated"), clip, folder, str(network))


def test_a_session_leads_to_the_command_lines_motion(
    blender: Blender, blender_on_screen: Blender, package: Path, repository: Path, tmp_path: Path
) -> None:
    """All steps go through, each is pictured, and the finished armature scores as `keymark convert` does.

    The extension has left its own folder as it was installed.
    """
    take = repository / "presets" / "demo" / "aerobic"
    folder = repository / "build" / "screenshots" / "demo"
    run_script(blender_on_screen, "session.py", STEPS, take, folder)

    output = tmp_path / "out"
    words = ["convert", take, "--output", output, "--quiet", "--no-report"]
    done = blender.run("--command", "keymark", *words)
    assert done.returncode == 0, done.stdout + done.stderr
    by_hand, by_command = (_score(file, take) for file in (folder / "motion.json", output / "motion.json"))
    assert by_hand.mpjpe == pytest.approx(by_command.mpjpe, abs=AGREEMENT_MM)
    assert by_hand.depth == pytest.approx(by_command.depth, abs=2.0 * AGREEMENT_MM)
    assert blender.changed_files(package) == set()


def test_keyframes_are_found_and_chosen(blender_on_screen: Blender, repository: Path) -> None:
    take = repository / "presets" / "demo" / "aerobic"
    folder = repository / "build" / "screenshots" / "library"
    run_script(blender_on_screen, "library_session.py", CHOOSING_STEPS, take, folder, "aerobic")


def test_few_clicks_lead_from_the_clip_to_a_motion(
    blender_on_screen: Blender, repository: Path, tmp_path: Path
) -> None:
    take = repository.parent / "shared" / "takes" / "kick"
    if not (take / "take.json").is_file():
        take = profile_take(repository / "presets" / "demo" / "aerobic", tmp_path / "profile")
    folder = repository / "build" / "screenshots" / "hurried"
    run_script(blender_on_screen, "hurried_session.py", HURRIED_STEPS, take, folder)
    clicks = int((folder / "summary.txt").read_text(encoding="utf-8").split()[0])
    assert clicks <= MOST_CLICKS
    assert _score(folder / "motion.json", take).rooted < UNPOSED_MM


def test_poses_put_right_by_mouse_harm_no_motion(blender_on_screen: Blender, repository: Path) -> None:
    take = repository / "presets" / "demo" / "greeting"
    folder = repository / "build" / "screenshots" / "drag"
    run_script(blender_on_screen, "drag_session.py", ("put_right",), take, folder, "keypoints.json", "2")
    errors = json.loads((folder / "errors.json").read_text(encoding="utf-8"))
    before, after = np.array(errors["0"]), np.array(errors["2"])
    assert (after < before + HARM_MM).all(), f"{before} to {after} mm"


def test_plain_clothes_lead_to_a_motion(
    blender: Blender, blender_on_screen: Blender, repository: Path, tmp_path: Path
) -> None:
    take = plain_take(repository / "presets" / "demo" / "aerobic", tmp_path / "plain")
    folder = repository / "build" / "screenshots" / "plain"
    run_script(blender_on_screen, "plain_session.py", PLAIN_STEPS, take, folder)
    output = tmp_path / "out"
    done = blender.run(
        *("--command", "keymark", "convert", take, "--output", output, "--quiet", "--no-report")
    )
    assert done.returncode == 0, done.stdout + done.stderr
    by_hand, by_command = (_score(file, take) for file in (folder / "motion.json", output / "motion.json"))
    assert by_hand.mpjpe == pytest.approx(by_command.mpjpe, abs=CLICKS_MM)


def test_clutter_is_brushed_away(blender_on_screen: Blender, repository: Path, tmp_path: Path) -> None:
    take = panelled_take(repository / "presets" / "demo" / "aerobic", tmp_path / "panelled")
    folder = repository / "build" / "screenshots" / "markers"
    panel = ",".join(map(str, PANEL))
    run_script(blender_on_screen, "markers_session.py", MARKER_STEPS, take, folder, panel)


def test_libraries_are_seen(blender_on_screen: Blender, repository: Path) -> None:
    take = repository / "presets" / "demo" / "aerobic"
    folder = repository / "build" / "screenshots" / "shelf"
    run_script(blender_on_screen, "shelf_session.py", SHELF_STEPS, take, folder)


@pytest.mark.parametrize(
    ("name", "screen"), [("states_720", ("1280", "720")), ("states_1080", ("1920", "1080"))]
)
def test_every_step_fits_into_the_sidebar(
    blender_on_screen: Blender, repository: Path, name: str, screen: tuple[str, str]
) -> None:
    take = repository / "presets" / "demo" / "greeting"
    folder = repository / "build" / "screenshots" / name
    run_script(blender_on_screen, "states_session.py", STATES, take, folder, screen=screen)


def plain_take(demo: Path, folder: Path) -> Path:
    folder.mkdir()
    for name in ("clip.mp4", "keyframes.json", "keypoints.json", "truth.json"):
        shutil.copy(demo / name, folder / name)
    fields = json.loads((demo / "take.json").read_text(encoding="utf-8"))
    for name in ("markers", "evidence"):
        fields.pop(name, None)
    (folder / "take.json").write_text(json.dumps(fields), encoding="utf-8")
    return folder


def _score(motion: Path, folder: Path) -> Score:
    take = read_take(folder)
    points = json.loads(motion.read_text(encoding="utf-8"))["points"]
    places = np.array([points[name] for name in HUMAN.point_names]).swapaxes(0, 1)
    truth = read_truth(folder / "truth.json", take.frame_start, len(places))
    return score_points(places, truth, take.keyframe_indices, take.camera)
