"""Names of the kinds of evidence; imports nothing, so that `--help` stays fast."""

MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS = "markers", "keypoints", "depth_hints", "contours"
EVIDENCE = (MARKERS, KEYPOINTS, DEPTH_HINTS, CONTOURS)
"""All kinds; a take's `evidence` names those that are used, by default whatever it has."""


def evidence_mistake(kinds: object) -> str | None:
    """What is wrong with a list of kinds of evidence, to follow "evidence is ..."; None where it is valid."""
    valid = f"a list of one or more of {', '.join(EVIDENCE)}"
    if not isinstance(kinds, list | tuple) or not kinds or not all(isinstance(one, str) for one in kinds):
        return f"it must be {valid}"
    unknown = [one for one in kinds if one not in EVIDENCE]
    if unknown or len(set(kinds)) < len(kinds):
        return f"it must be {valid}, each once"
    if DEPTH_HINTS in kinds and KEYPOINTS not in kinds:
        return f"{DEPTH_HINTS} are guesses of the depth of keypoints and need {KEYPOINTS} beside them"
    return None


def in_order(kinds: tuple[str, ...] | list[str]) -> tuple[str, ...]:
    """The kinds in the order of `EVIDENCE`."""
    return tuple(kind for kind in EVIDENCE if kind in kinds)
