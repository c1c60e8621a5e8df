"""Options that the commands for shoots share: what counts for takes of which the shoot says nothing."""

import argparse

from ....core.take.methods import METHODS
from .evidence_options import add_evidence, add_keypoint_names

SHOOT_HELP = "folder of takes, or a list of them (JSON Lines, .jsonl)"


def add_defaults(parser: argparse.ArgumentParser) -> None:
    """Add keypoints, evidence, library, floor and method for takes whose shoot names none."""
    add_keypoint_names(parser)
    add_evidence(parser, " where nothing in SHOOT says it")
    parser.add_argument(
        "--library",
        metavar="NAME|FILE|auto",
        type=_none_if_empty,
        help="match takes with this keyframe library where nothing in SHOOT names one",
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


def _none_if_empty(text: str) -> str | None:
    """The text; None for an empty one, which farms pass for a setting that is not filled in."""
    return text or None
