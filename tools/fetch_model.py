"""Put the network that finds keypoints where Keymark looks for it, once; see presets/models/NOTICE.

It lies in public archives: the large network in npm's @mediapipe/pose; a smaller, less exact one in pip's
mediapipe, which is taken where there is no npm, unless --best is given. `convert_network` makes ONNX of it.
The checksums before and after stand in presets/models/SHA256SUMS.
"""

import hashlib
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

from convert_network import onnx_of

ROOT = Path(__file__).resolve().parents[1]
FOLDER = ROOT / "presets" / "models"
MODEL = FOLDER / "pose_landmark.onnx"
CACHE = ROOT / ".cache"
LARGE, SMALL = "pose_landmark_heavy.tflite", "pose_landmark_full.tflite"
NPM, PIP = "@mediapipe/pose@0.5.1675469404", "mediapipe==0.10.14"
OUTPUTS = ("Identity", "Identity_1", "Identity_3", "Identity_4")
"""Points, presence, heat maps and points in space: all but the picture of where the person is."""
WHEEL = ["--only-binary=:all:", "--python-version", "3.11", "--platform", "manylinux2014_x86_64"]


def checksums() -> dict[str, str]:
    """Checksum by file."""
    lines = (FOLDER / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    return {name: checksum for checksum, name in map(str.split, lines)}


def large(folder: Path) -> bytes:
    """The large network."""
    npm = shutil.which("npm")
    if npm is None:
        raise FileNotFoundError("there is no npm")
    subprocess.run([npm, "pack", "--silent", NPM], cwd=folder, check=True, stdout=sys.stderr)
    (archive,) = folder.glob("*.tgz")
    with tarfile.open(archive) as tar:
        file = tar.extractfile(f"package/{LARGE}")
        assert file is not None
        return file.read()


def small(folder: Path) -> bytes:
    """The smaller network."""
    words = [sys.executable, "-m", "pip", "download", "--quiet", "--disable-pip-version-check", "--no-deps"]
    subprocess.run([*words, *WHEEL, "--dest", str(folder), PIP], check=True, stdout=sys.stderr)
    (archive,) = folder.glob("*.whl")
    with zipfile.ZipFile(archive) as wheel:
        return wheel.read(f"mediapipe/modules/pose_landmark/{SMALL}")


def fetched(names: list[str]) -> tuple[str, bytes]:
    """The first network of these that can be had, and its name."""
    reasons = []
    for name in names:
        CACHE.mkdir(exist_ok=True)
        kept = CACHE / name
        with tempfile.TemporaryDirectory(dir=CACHE) as folder:
            try:
                source = large if name == LARGE else small
                weights = kept.read_bytes() if kept.is_file() else source(Path(folder))
            except (OSError, subprocess.SubprocessError, KeyError, ValueError) as error:
                reasons.append(f"{name}: {error}")
                continue
            check(name, weights)
            whole = Path(folder, name)
            whole.write_bytes(weights)
            os.replace(whole, kept)
        return name, weights
    raise SystemExit(f"The network that finds keypoints cannot be fetched ({'; '.join(reasons)}).")


def converted(name: str) -> str:
    """The name under which a network's checksum as ONNX stands in the list."""
    return name.replace(".tflite", ".onnx")


def check(name: str, data: bytes) -> None:
    """End the program unless a file is the one whose checksum is listed."""
    if hashlib.sha256(data).hexdigest() != checksums()[name]:
        raise SystemExit(f"{name}: its checksum is not that of presets/models/SHA256SUMS.")


def main(arguments: list[str]) -> int:
    """Fetch it unless it is there."""
    names = [LARGE] if "--best" in arguments else [LARGE, SMALL]
    there = hashlib.sha256(MODEL.read_bytes()).hexdigest() if MODEL.is_file() else ""
    if there in [checksums()[converted(name)] for name in names]:
        MODEL.touch()
        return 0
    name, weights = fetched(names)
    network = onnx_of(weights, OUTPUTS)
    check(converted(name), network)
    part = MODEL.with_suffix(".part")
    part.write_bytes(network)
    os.replace(part, MODEL)
    print(f"{MODEL.relative_to(ROOT)} is MediaPipe's {name}.", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
