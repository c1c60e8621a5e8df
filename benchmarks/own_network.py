"""A simulated network of one's own, from a bare clip and a height: with it, without, and where it is wrong.

Usage: own_network.py [TAKE ...] [--ways WAY ...] with names or folders of takes that have the file of a
simulated network's motion, `network_mhr70.csv`. See README.md.
"""

import argparse
import json
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
from takes import OUTPUT, chosen_takes, load_project, write_results

load_project()

from animate import LIBRARIES, errors_of, from_clip  # noqa: E402
from keymark.core.arrays import Array, Image  # noqa: E402
from keymark.core.body.human import HUMAN  # noqa: E402
from keymark.core.detect.closer_look import CloserLook  # noqa: E402
from keymark.core.detect.families.instant_hmr import HIPS, LAYOUT  # noqa: E402
from keymark.core.detect.families.network import Box  # noqa: E402
from keymark.core.detect.keypoint_file import write_keypoints  # noqa: E402
from keymark.core.detect.keypoints import mirrored_point  # noqa: E402
from keymark.core.detect.pose_network import Look, PoseNetwork  # noqa: E402
from keymark.core.detect.pose_tracking import find_people  # noqa: E402
from keymark.core.estimate.reconstruct import Reconstruction  # noqa: E402
from keymark.core.prior.library import Library  # noqa: E402
from keymark.core.prior.registry import find_libraries  # noqa: E402
from keymark.core.prior.texts import EVERY_LIBRARY  # noqa: E402
from keymark.core.progress import run  # noqa: E402
from keymark.core.review.score import read_truth  # noqa: E402
from keymark.core.session.session import Posed  # noqa: E402
from keymark.core.take.take import Take  # noqa: E402
from keymark.core.take.take_file import read_take  # noqa: E402
from keymark.core.video.clip import Clip  # noqa: E402

FILE = "network_mhr70.csv"
MIRRORED = [LAYOUT.names.index(mirrored_point(name)) for name in LAYOUT.names]
AS_POINT = {LAYOUT.names.index(name): at for at, name in enumerate(HUMAN.point_names) if name != "head"}
EARS = [LAYOUT.names.index(f"ear.{side}") for side in "LR"]
WITHOUT, WITH = "without", "as it is"

Said = tuple[Array, Array | None]
"""What it says: points (F, N, 2) in the picture [px], and (F, N, 3) in space about the hips [m]."""


def said(folder: Path, take: Take, truth: Array) -> tuple[Array, Array, Array]:
    """What the network says of a clip, and (F, N, 3) by how much the points in space are off.

    Those in the picture are the same ones where the hips truly are: a network of this family errs alike.
    """
    table = np.genfromtxt(folder / FILE, delimiter=",", skip_header=1)[: len(truth)]
    table = table.reshape(len(truth), LAYOUT.count, 3)
    for frame in np.flatnonzero((table == 0.0).all(axis=(1, 2))):  # in which it has found nobody
        table[frame] = table[max(frame - 1, 0)]
    space = table[:, LAYOUT.numbers]
    space = space - space[:, HIPS].mean(axis=1, keepdims=True)
    true = take.camera.world_to_camera(truth, np.arange(len(truth))[:, None]) * [1.0, -1.0, -1.0]
    hips = true[:, [HUMAN.point_names.index(f"hip.{side}") for side in "LR"]].mean(axis=1, keepdims=True)
    error = np.zeros_like(space)
    error[:, list(AS_POINT)] = space[:, list(AS_POINT)] - (true - hips)[:, list(AS_POINT.values())]
    head = (true - hips)[:, HUMAN.point_names.index("head")]
    error[:, EARS] = (space[:, EARS].mean(axis=1) - head)[:, None]
    there = space + hips
    return take.camera.focal_px * there[..., :2] / there[..., 2:] + take.camera.principal_point, space, error


def _erring(mm: float) -> Callable[[Array, Array, Array], Said]:
    def change(pixel: Array, space: Array, error: Array) -> Said:
        usual = 1e3 * np.linalg.norm(error[:, [*AS_POINT, EARS[0]]], axis=-1).mean()
        return pixel, space + (mm / usual - 1.0) * error

    return change


def _leaning(pixel: Array, space: Array, error: Array) -> Said:
    return pixel, 0.5 * (space + space.mean(axis=0))


def _shuffled(frames: int) -> Array:
    return np.random.default_rng(5).permutation(frames)


def _constant(pixel: Array) -> Array:
    middle = pixel[:, HIPS].mean(axis=1, keepdims=True)
    return np.asarray(pixel[0] - middle[0] + middle)


WAYS: dict[str, Callable[[Array, Array, Array], Said]] = {
    WITH: lambda pixel, space, error: (pixel, space),
    "points in the picture alone": lambda pixel, space, error: (pixel, None),
    "in space 90 mm off": _erring(90.0),
    "in space 120 mm off": _erring(120.0),
    "in space 150 mm off": _erring(150.0),
    "in space leaning to the mean": _leaning,
    "in space mirrored in depth": lambda pixel, space, error: (pixel, space * [1.0, 1.0, -1.0]),
    "in space shuffled": lambda pixel, space, error: (pixel, space[_shuffled(len(space))]),
    "in space left for right": lambda pixel, space, error: (pixel, space[:, MIRRORED]),
    "in space one pose": lambda pixel, space, error: (pixel, np.broadcast_to(space[0], space.shape)),
    "shuffled": lambda pixel, space, error: (pixel[_shuffled(len(space))], space[_shuffled(len(space))]),
    "left for right": lambda pixel, space, error: (pixel[:, MIRRORED], space[:, MIRRORED]),
    "one pose": lambda pixel, space, error: (
        _constant(pixel),
        np.broadcast_to(space[0], space.shape),
    ),
}


class Simulated:
    """In place of a network that has been read: it knows pictures of a clip again."""

    layout, file, name = LAYOUT, SimpleNamespace(digest="0" * 64), "a simulated network"

    def __init__(self, clip: Clip, pixel: Array, space: Array | None) -> None:
        self._frame = {picture.tobytes(): index for index, _, picture in clip.frames()}
        self._pixel, self._space, self.motion = pixel, space, space is not None

    def each(self, asked: Sequence[tuple[Image, Box]]) -> list[Look]:
        """See `Network`."""
        frames = [self._frame[picture.tobytes()] for picture, _ in asked]
        return [
            Look(self._pixel[one], None, None if self._space is None else self._space[one]) for one in frames
        ]


Found = tuple[float, float, str]
"""Error of a motion after one similarity, and hips aligned [mm], and what was said of the network."""


def measure(way: str, name: str, folder: Path, libraries: Sequence[Library], without: Found | None) -> Found:
    """What a way makes of a take; `without` where the network is left out, whose keypoints are the same."""
    take = read_take(folder, keyframes_required=False, whole=True)
    clip = Clip.open(take.clip)
    truth = read_truth(folder / "truth.json", take.frame_start, clip.frame_count)
    kept = OUTPUT / "own_network" / f"{name.replace('/', '_')}.{way.replace(' ', '_')}.json"
    if not kept.is_file():  # of an earlier run: detecting takes time
        network = None if way == WITHOUT else Simulated(clip, *WAYS[way](*said(folder, take, truth)))
        people = run(find_people(clip, PoseNetwork(), CloserLook(cast(Any, network), hands=False)))
        kept.parent.mkdir(parents=True, exist_ok=True)
        write_keypoints(kept, people, take.frame_start, take.fps)
        kept.with_suffix(".txt").write_text("\n".join(people.notes), encoding="utf-8")
    plain = kept.with_name(f"{name.replace('/', '_')}.{WITHOUT}.json")
    if without is not None and kept.read_bytes() == plain.read_bytes():
        return *without[:2], kept.with_suffix(".txt").read_text(encoding="utf-8")
    _, made, _ = from_clip(take, kept, libraries)
    errors = errors_of(made[Reconstruction].motion.points, truth, take.fps)
    notes = [kept.with_suffix(".txt").read_text(encoding="utf-8")]
    referred = made[Posed].referred
    return errors.similar_mm, errors.rooted_mm, " ".join(notes if referred is None else referred.notes[:1])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("takes", nargs="*")
    parser.add_argument("--ways", nargs="+", choices=WAYS, default=list(WAYS))
    given = parser.parse_args()
    takes = chosen_takes(given.takes, plain=True)
    takes = {name: folder for name, folder in takes.items() if (folder / FILE).is_file()}
    libraries = find_libraries(EVERY_LIBRARY, [LIBRARIES])
    found: dict[str, dict[str, Found]] = {}
    lines = [f"| similarity, hips [mm] | {' | '.join(takes)} | ratio |", f"|---|{'---:|' * (len(takes) + 1)}"]
    for way in (WITHOUT, *given.ways):
        found[way] = {}
        for name, folder in takes.items():
            found[way][name] = measure(way, name, folder, libraries, found[WITHOUT].get(name))
            print(way, name, *found[way][name], file=sys.stderr, flush=True)
        ratios = [found[way][name][0] / found[WITHOUT][name][0] for name in takes]
        cells = [f"{similar:.0f}, {rooted:.0f}" for similar, rooted, _ in found[way].values()]
        lines.append(f"| {way} | {' | '.join(cells)} | {np.mean(ratios):.2f}, at most {max(ratios):.2f} |")
    write_results("own_network", "\n".join(lines), json.dumps(found, indent=1))


if __name__ == "__main__":
    main()
