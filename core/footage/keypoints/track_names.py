"""Which body point a track is meant to follow, by the name that a person gave it."""

import re
from functools import lru_cache

from .body_points import BODY_POINTS

SIDE_WORDS = {"l": "L", "left": "L", "r": "R", "right": "R"}
SYNONYMS = {
    "skull": "head",
    "head top": "crown",
    "top of head": "crown",
    "top head": "crown",
    "vertex": "crown",
    "throat": "neck",
    "hips": "pelvis",
    "hip": "pelvis",
    "root": "pelvis",
    "big toe": "toe",
    "toes": "toe",
    "little toe": "small_toe",
    "small toe": "small_toe",
    "pinky toe": "small_toe",
    "index finger": "index",
    "little finger": "pinky",
}
"""Other words for a body point, sides left out; hips without a side are the middle between both."""
WORDS = re.compile(r"[A-Z]+(?![a-z])|[A-Z]?[a-z]+")
"""Words of a name, whatever separates them, as in `LeftWrist`, `left_wrist` and `wrist.L`; no numbers."""

MOST_NAMES = 4096
"""Names that are remembered: panels ask for those of all tracks of a clip whenever they are drawn."""


@lru_cache(maxsize=MOST_NAMES)
def named_point(name: str) -> str | None:
    """Body point that a track is named after, as `wrist.L`, `Left Wrist` or `l_wrist.001`; None if none."""
    words = [word.lower() for word in WORDS.findall(name)]
    sides = {SIDE_WORDS[word] for word in words if word in SIDE_WORDS}
    part = " ".join(word for word in words if word not in SIDE_WORDS)
    if len(sides) > 1 or not part:
        return None
    (side,) = sides or {""}
    if side:
        stems = (part.replace(" ", "_"), SYNONYMS.get(part, ""))
        candidates = [f"{stem}.{side}" for stem in stems]
    else:
        candidates = [part, SYNONYMS.get(part, "")]
    return next((point for point in candidates if point in BODY_POINTS), None)
