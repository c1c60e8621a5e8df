"""Parts along the bones of the middle, from the root to the top of the head, which never fall back.

The likeliest one by the Viterbi recursion, the probability of each part by forward and backward recursion.
"""

import numpy as np

from ...arrays import Array, IndexArray

STATES = ("below", "hips", "spine", "neck", "head", "end")
"""What a bone of the path may be, in this order."""
HEAD, END = STATES.index("head"), STATES.index("end")
FOLLOWERS = {
    "below": ("below", "hips"),
    "hips": ("spine", "neck", "head"),
    "spine": ("spine", "neck", "head"),
    "neck": ("neck", "head"),
    "head": ("end",),
    "end": ("end",),
}
"""What may come after each: one hips and at most one head."""
NO_HEAD = -5.0
"""Score of a sequence without a head."""

_STEP = np.array([[0.0 if after in FOLLOWERS[before] else -np.inf for after in STATES] for before in STATES])
_FIRST = np.array([0.0, 0.0, *[-np.inf] * 4])
_LAST = np.array([-np.inf, NO_HEAD, NO_HEAD, NO_HEAD, 0.0, 0.0])


def likeliest_states(scores: Array, tops: Array) -> tuple[IndexArray, float]:
    """The likeliest sequence.

    Args:
        scores: (K, 6) log-likelihood of each state of each bone.
        tops: (K,) log-likelihood that a bone is the first above the head.

    Returns:
        (K,) states, and their log-likelihood: -inf where no sequence is possible.
    """
    best = _FIRST + scores[0]
    back = np.zeros(scores.shape, dtype=np.intp)
    for row in range(1, len(scores)):
        ways = best[:, None] + _steps(tops[row])
        back[row] = np.argmax(ways, axis=0)
        best = np.max(ways, axis=0) + scores[row]
    best = best + _LAST
    states = np.zeros(len(scores), dtype=np.intp)
    states[-1] = np.argmax(best)
    for row in range(len(scores) - 1, 0, -1):
        states[row - 1] = back[row, states[row]]
    return states, float(np.max(best))


def state_probabilities(scores: Array, tops: Array) -> Array:
    """(K, 6) probability of each state of each bone over all sequences, for the arguments above."""
    with np.errstate(divide="ignore", invalid="ignore"):
        forward, backward = np.empty(scores.shape), np.empty(scores.shape)
        forward[0] = _FIRST + scores[0]
        backward[-1] = _LAST
        for row in range(1, len(scores)):
            ways = forward[row - 1][:, None] + _steps(tops[row])
            forward[row] = np.logaddexp.reduce(ways, axis=0) + scores[row]
        for row in range(len(scores) - 2, -1, -1):
            ways = _steps(tops[row + 1]) + (scores[row + 1] + backward[row + 1])[None]
            backward[row] = np.logaddexp.reduce(ways, axis=1)
        both = forward + backward
        return np.asarray(np.exp(both - np.logaddexp.reduce(both, axis=1, keepdims=True)))


def _steps(top: float) -> Array:
    steps = _STEP.copy()
    steps[HEAD, END] = top
    return steps
