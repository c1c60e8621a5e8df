"""Test footage of many formats and faults, made with ffmpeg from one drawn performer.

Each frame carries its own number as black and white blocks along its upper border, so that a decoded frame
can be identified.
"""

import json
import subprocess
from pathlib import Path

import cv2
import imageio_ffmpeg
import numpy as np
from _synthetic_take import SIZE, write_synthetic_take

BITS = 8
BLOCK = SIZE[0] // BITS
FRAMES = 24
FPS = 30


def ffmpeg(*arguments: str | Path) -> None:
    """Run ffmpeg on one core; what it says is shown where it fails."""
    command = [imageio_ffmpeg.get_ffmpeg_exe(), "-v", "error", "-nostdin", "-y", "-threads", "1"]
    done = subprocess.run([*command, *map(str, arguments)], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{' '.join(map(str, arguments))}: {done.stderr}"


def write_numbered_take(folder: Path, frames: int = FRAMES) -> Path:
    """A drawn take whose images, `frames/0001.png` and so on, carry their numbers; returns the folder."""
    write_synthetic_take(folder, frames)
    for index, file in enumerate(sorted((folder / "frames").iterdir())):
        image = cv2.imread(str(file))
        cv2.imwrite(str(file), numbered(image, index))
    return folder


def numbered(image: np.ndarray, index: int) -> np.ndarray:
    """The image with a number written into it, the highest bit on the left."""
    image = image.copy()
    for bit in range(BITS):
        lit = index >> (BITS - 1 - bit) & 1
        image[:10, bit * BLOCK : (bit + 1) * BLOCK] = 235 if lit else 20
    return image


def number_of(image: np.ndarray) -> int:
    """The number written into an image of any size, read in the middle of each block."""
    height, width = image.shape[:2]
    row = image[int(height * 5 / SIZE[1]), [int((bit + 0.5) * width / BITS) for bit in range(BITS)]]
    return int("".join("1" if level > 127 else "0" for level in row.mean(axis=-1)), 2)


def images_of(take: Path) -> list[str | Path]:
    """The arguments that let ffmpeg read a take's images."""
    return ["-framerate", str(FPS), "-i", take / "frames" / "%04d.png"]


def encode(take: Path, file: Path, *arguments: str | Path) -> Path:
    """A take's images as a video; arguments for the output are ffmpeg's."""
    file.parent.mkdir(parents=True, exist_ok=True)
    ffmpeg(*images_of(take), *(arguments or H264), file)
    return file


H264 = ("-c:v", "libx264", "-crf", "12", "-pix_fmt", "yuv420p", "-preset", "veryfast")


def take_with(clip: Path, take: Path, **said: object) -> Path:
    """A take of another clip that is described like a drawn one, in the clip's own folder."""
    fields = json.loads((take / "take.json").read_text(encoding="utf-8"))
    fields.pop("frame_count")
    fields |= {"clip": clip.name, **said}
    (clip.parent / "take.json").write_text(json.dumps(fields), encoding="utf-8")
    keyframes = (take / "keyframes.json").read_text(encoding="utf-8")
    (clip.parent / "keyframes.json").write_text(keyframes, encoding="utf-8")
    return clip.parent


def overwritten(file: Path, start: float, length: int, seed: int = 0) -> Path:
    """Overwrite bytes of a file with noise, beginning at a share of its length."""
    data = bytearray(file.read_bytes())
    at = int(start * len(data))
    noise = np.random.default_rng(seed).integers(0, 256, length, dtype=np.uint8).tobytes()
    data[at : at + length] = noise[: max(len(data) - at, 0)]
    file.write_bytes(bytes(data))
    return file


def cut_off(file: Path, share: float) -> Path:
    """Keep only the first part of a file."""
    data = file.read_bytes()
    file.write_bytes(data[: int(share * len(data))])
    return file
