"""Options on the evidence of takes: keypoint files, and the kinds that are used."""

import argparse
from pathlib import Path, PureWindowsPath

from ....core.take.evidence_kinds import EVIDENCE, evidence_mistake, in_order

KINDS = ",".join(EVIDENCE)


def add_evidence(parser: argparse.ArgumentParser, condition: str = "") -> None:
    """Add the kinds of evidence; `condition` says for which takes the option counts."""
    parser.add_argument(
        "--evidence",
        metavar="KINDS",
        type=_kinds,
        help=f"what the motion is held against{condition}, one or more of {KINDS}; by default whatever a "
        "take has",
    )


def add_keypoint_files(parser: argparse.ArgumentParser) -> None:
    """Add keypoint files of one take."""
    parser.add_argument(
        "--keypoints",
        metavar="FILE",
        type=Path,
        action="append",
        help="file or folder of keypoints that a detector has found in the clip; may be given several times; "
        "by default TAKE/keypoints.json where it is there",
    )


def add_keypoint_names(parser: argparse.ArgumentParser) -> None:
    """Add keypoint files by the name that they have in every take."""
    parser.add_argument(
        "--keypoints",
        metavar="NAME",
        type=_name_in_take,
        action="append",
        help="name of the keypoint file or folder of every take where nothing in SHOOT names one: "
        "TAKE/NAME, or CLIP.NAME beside a clip; may be given several times; by default keypoints.json where "
        "it is there",
    )


def _kinds(text: str) -> tuple[str, ...] | None:
    """The kinds of evidence; None for an empty text, which farms pass for a setting that is not filled in."""
    if not text:
        return None
    kinds = [kind.strip().replace("-", "_") for kind in text.split(",")]
    mistake = evidence_mistake(kinds)
    if mistake is not None:
        raise argparse.ArgumentTypeError(f"evidence is {text}; {mistake}")
    return in_order(kinds)


def _name_in_take(text: str) -> Path | None:
    """A path within a take; None for an empty text, as above."""
    if not text:
        return None
    path = PureWindowsPath(text)  # it reads both kinds of slash
    if path.anchor or Path(text).is_absolute() or ".." in path.parts or not path.name:
        raise argparse.ArgumentTypeError(
            f"keypoints is {text}; the name that the file has in every take is valid, as in keypoints.json"
        )
    return Path(text)
