"""How far off a camera is that was found from lines or from the performer, and what that costs.

Usage: camera.py [TAKE ...] [--motion TAKE ...] with names or folders of takes with truth. See README.md.
"""

import argparse
import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np
from camera_room import drawn_room, standing_clicks
from keyframing import exact_postures
from takes import ROOT, chosen_takes, load_project, write_results
from trials import Trial, read_trial

load_project()

from keymark.core.api import reconstruct  # noqa: E402
from keymark.core.body.body_volume import standing_height_m  # noqa: E402
from keymark.core.body.kinematics import Body  # noqa: E402
from keymark.core.camera.camera import Camera, default_camera_pose, guess_lens  # noqa: E402
from keymark.core.camera.camera_evidence import CameraEvidence, Uprights  # noqa: E402
from keymark.core.camera.camera_fields import CameraPlacement  # noqa: E402
from keymark.core.camera.camera_fit import HEIGHT, LENS, PARAMETERS, ROLL, TILT, fit_camera  # noqa: E402
from keymark.core.detect.keypoint_file import read_keypoints  # noqa: E402
from keymark.core.detect.standing_moments import standing_keypoints  # noqa: E402
from keymark.core.poses.clip import pose_clip  # noqa: E402
from keymark.core.poses.found_poses import with_found  # noqa: E402
from keymark.core.prior.keyframes import Keyframe  # noqa: E402
from keymark.core.prior.registry import find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import Score, read_truth  # noqa: E402
from keymark.core.session.stages import seen_in  # noqa: E402
from keymark.core.take.performer_keypoints import performer_keypoints  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402

LIBRARIES = ROOT / "presets" / "keyframes"
PUT, LINES, PERFORMER, WALK = WAYS = ("as put", "lines", "performer", "walk")
DRAWINGS = 12
"""Rooms and hands, each from a seed of its own."""
UNITS = {HEIGHT: 100.0, TILT: float(np.degrees(1.0)), ROLL: float(np.degrees(1.0)), LENS: 100.0}
TITLES = ("take", "way", "lens", "height [cm]", "tilt [deg]", "roll [deg]", "lens [%]", "kept", "sigmas")
KEYPOINTS = ("keypoints_mediapipe.json", "keypoints.json")


@dataclass(frozen=True)
class Found:
    """A camera that was found one way, against the true one."""

    error: dict[str, float]
    """Of height [m], tilt and roll [rad], and lens [share]."""
    std: dict[str, float]
    """As stated, in the same units."""
    kept: tuple[str, ...]
    camera: Camera


def guessed(true: Camera, lens_is_known: bool) -> Camera:
    """The camera as it is put, at the true one's place on the floor and heading: only these are arbitrary."""
    guess = guess_lens(true.resolution)
    lens = (true.lens_mm, true.sensor_width_mm) if lens_is_known else (guess.lens_mm, guess.sensor_width_mm)
    put = CameraPlacement.of(default_camera_pose(*lens, true.resolution))
    pose = put.applied_to(true.matrix_world)
    return replace(
        true, lens_mm=lens[0], sensor_width_mm=lens[1], matrix_world=pose, shift_x=0.0, shift_y=0.0
    )


def found_by(evidence: CameraEvidence, true: Camera, lens_is_known: bool) -> Found:
    """The camera that the evidence shows, from the one that was put there."""
    fit = fit_camera(guessed(true, lens_is_known), evidence, lens_is_known)
    lens = fit.camera.lens_mm
    std = {**fit.std, LENS: fit.std[LENS] / lens}
    return Found(_errors(fit.camera, true), std, fit.kept, fit.camera)


def _errors(camera: Camera, true: Camera) -> dict[str, float]:
    now, known = CameraPlacement.of(camera.matrix_world), CameraPlacement.of(true.matrix_world)
    return {
        HEIGHT: now.height_m - known.height_m,
        TILT: now.tilt_rad - known.tilt_rad,
        ROLL: now.roll_rad - known.roll_rad,
        LENS: float(np.log(camera.focal_px / true.focal_px)),
    }


def cameras_of(folder: Path, take: Take, truth: np.ndarray, lens_is_known: bool) -> dict[str, list[Found]]:
    """Cameras found in one take, by way."""
    true, stature = take.camera, standing_height_m(take.body)
    ways: dict[str, list[Found]] = {way: [] for way in WAYS}
    put = guessed(true, lens_is_known)
    ways[PUT].append(Found(_errors(put, true), dict.fromkeys(PARAMETERS, np.nan), PARAMETERS, put))
    for seed in range(DRAWINGS):
        random = np.random.default_rng(seed)
        clicks = standing_clicks(take, truth, random)
        room = drawn_room(true, truth, random)
        one = Uprights.persons(clicks[:1, 0], clicks[:1, 1], stature)
        ways[LINES].append(found_by(replace(room, uprights=one), true, lens_is_known))
        if len(clicks):
            people = CameraEvidence(uprights=Uprights.persons(clicks[:, 0], clicks[:, 1], stature))
            ways[PERFORMER].append(found_by(people, true, lens_is_known))
    walked = walk_of(folder, take)
    if len(walked) > 1:
        ways[WALK].append(found_by(CameraEvidence(uprights=walked), true, lens_is_known))
    return ways


def walk_of(folder: Path, take: Take) -> Uprights:
    """Moments in which the take's detector sees the performer upright."""
    file = next((folder / name for name in KEYPOINTS if (folder / name).is_file()), None)
    if file is None or take.frame_count is None:
        return Uprights.none()
    people = read_keypoints(file, take.frame_count, take.camera.resolution, take.fps, take.frame_start)
    seen = performer_keypoints(replace(take, keypoints=(people,), keyframes=()))
    return standing_keypoints(seen, take.body, take.fps)


def row(take: str, way: str, lens: str, found: Sequence[Found]) -> str:
    """A row of the table: root mean square errors, how often a part was kept, and errors in sigmas."""
    cells = []
    for name in PARAMETERS:
        errors = np.array([one.error[name] for one in found])
        cells.append(f"{UNITS[name] * np.sqrt(np.mean(errors**2)):.1f}")
    kept = [name for name in PARAMETERS if np.mean([name in one.kept for one in found]) > 0.5]
    sigmas = [one.error[name] / one.std[name] for one in found for name in PARAMETERS if name not in one.kept]
    said = f"{np.sqrt(np.mean(np.square(sigmas))):.2f}" if sigmas else "-"
    return f"| {take} | {way} | {lens} | {' | '.join(cells)} | {', '.join(kept) or '-'} | {said} |"


def motion_rows(folder: Path) -> Iterator[tuple[str, dict[str, Score]]]:
    """Scores of a take's motion through the true camera and through each found one."""
    trial = read_trial(folder)
    true, ways = trial.take.camera, cameras_of(folder, trial.take, trial.truth, False)
    yield "true camera", scores(trial, true)
    for way, found in ways.items():
        if found:
            yield way, scores(trial, found[0].camera)


def scores(trial: Trial, camera: Camera) -> dict[str, Score]:
    """Posed over the picture by somebody who sees it through that camera, and not posed at all."""
    seen = replace(trial, take=replace(trial.take, camera=camera, keyframes=seen_through(trial, camera)))
    motion = seen.estimated("map")
    libraries = find_libraries(EVERY_LIBRARY, [LIBRARIES])
    bare = replace(seen.take, keyframes=())
    poses = run(pose_clip(seen_in(bare, trial.reading), libraries))
    reading = poses.reading or trial.reading
    unposed = run(reconstruct(with_found(bare, poses), "map", reading)).motion
    return {"posed": trial.score(motion.points), "not posed": trial.score(unposed.points)}


def seen_through(trial: Trial, camera: Camera) -> tuple[Keyframe, ...]:
    """Exact keyframes as they look the same through another camera.

    They turn with it, and are as much farther away as its lens is longer.
    """
    true, body = trial.take.camera, trial.take.body
    exact = exact_postures(trial)
    index = list(trial.take.keyframe_indices)
    posed = exact[np.array(index)]
    turn = camera.matrix_world[:3, :3] @ true.matrix_world[:3, :3].T
    there = true.world_to_camera(_hips(body, body.points(body.pose(posed))))
    farther = there * np.array([1.0, 1.0, camera.focal_px / true.focal_px])
    place = camera.matrix_world[:3, 3] + farther @ camera.matrix_world[:3, :3].T
    rotations = np.array(posed.rotations)
    rotations[:, 0] = turn @ rotations[:, 0]
    turned = replace(posed, rotations=rotations)
    turned = replace(
        turned, translation=turned.translation + place - _hips(body, body.points(body.pose(turned)))
    )
    return tuple(Keyframe(at, turned[number]) for number, at in enumerate(index))


def _hips(body: Body, points: np.ndarray) -> np.ndarray:
    names = body.skeleton.point_names
    return points[:, [names.index("hip.L"), names.index("hip.R")]].mean(axis=1)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*")
    parser.add_argument("--motion", nargs="*", default=[], metavar="TAKE")
    words = parser.parse_args()
    lines = ["| " + " | ".join(TITLES) + " |", "|" + "---|" * len(TITLES)]
    numbers: dict[str, object] = {}
    everything: dict[tuple[str, str], list[Found]] = {}
    for name, folder in chosen_takes(words.takes, plain=True).items():
        take = read_take(folder, whole=True)
        truth = read_truth(folder / "truth.json", take.frame_start, take.frame_count)
        for lens_is_known in (False, True):
            lens = "known" if lens_is_known else "guessed"
            for way, found in cameras_of(folder, take, truth, lens_is_known).items():
                if found:
                    lines.append(row(name, way, lens, found))
                    print(lines[-1], file=sys.stderr, flush=True)
                    everything.setdefault((way, lens), []).extend(found)
                    numbers[f"{name}, {way}, {lens}"] = [
                        {**asdict(replace(one, camera=None)), "camera": None} for one in found
                    ]
    lines += [row("**all**", way, lens, found) for (way, lens), found in everything.items()]
    if words.motion:
        lines += [
            "",
            "| take | camera | posed: hips aligned | in place | not posed: hips aligned | in place |",
        ]
        lines.append("|---|---|---|---|---|---|")
    for name, folder in chosen_takes(words.motion, plain=True).items() if words.motion else ():
        for way, both in motion_rows(folder):
            cells = [f"{score.rooted:.1f} | {score.mpjpe:.1f}" for score in both.values()]
            lines.append(f"| {name} | {way} | {' | '.join(cells)} |")
            numbers[f"motion of {name}, {way}"] = {key: asdict(score) for key, score in both.items()}
    write_results("camera", "\n".join(lines), json.dumps(numbers, indent=1, default=float))


if __name__ == "__main__":
    main()
