"""Options that the commands for shoots share: what counts for takes of which the shoot says nothing."""

import argparse

from ....core.library.several_libraries import EVERY_LIBRARY
from ....core.take.methods import METHODS
from .evidence_options import add_evidence, add_keypoint_names

SHOOT_HELP = "folder of takes, or a list of them (JSON Lines, .jsonl)"


def add_defaults(parser: argparse.ArgumentParser) -> None:
    """Add keypoints, evidence, keyframes, library, floor and method for takes whose shoot names none."""
    add_keypoint_names(parser)
    add_evidence(parser, " where nothing in SHOOT says it")
    parser.add_argument(
        "--keyframes",
        metavar="auto",
        type=_auto,
        help="auto: find keyframes in the footage with all libraries there are, beside those that a take has "
        "posed, where nothing in SHOOT says how",
    )
    parser.add_argument(
        "--library",
        metavar="NAME|FILE|auto",
        type=_none_if_empty,
        help="find keyframes by matching takes with this keyframe library alone where nothing in SHOOT says "
        "how; auto is --keyframes auto",
    )
    parser.add_argument(
        "--floor",
        metavar="HEIGHT",
        type=float,
        help="height of the floor in meters where nothing in SHOOT says it",
    )
    parser.add_argument(
        "--method", choices=METHODS, help="method where nothing in SHOOT names one; map is the default"
    )


def _auto(text: str) -> str | None:
    """The word for finding keyframes; None for an empty text, as below."""
    if text not in ("", EVERY_LIBRARY):
        raise argparse.ArgumentTypeError(
            f"keyframes is {text}; {EVERY_LIBRARY} is valid: a keyframe file is a take's own, named in its "
            "description"
        )
    return text or None


def _none_if_empty(text: str) -> str | None:
    """The text; None for an empty one, which farms pass for a setting that is not filled in."""
    return text or None
