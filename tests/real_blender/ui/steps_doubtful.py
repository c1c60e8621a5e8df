"""Doubtful found keyframes set right: a candidate chosen, the performer turned, a limb flipped, or accepted.

What the person sees in footage and side view stands in `truth.json`; what does not help is taken back.
"""

from typing import Any

import numpy as np
from driver import Steps, expect, turns, until
from numpy.typing import NDArray
from person import Person, keymark
from steps_correct import seen

Points = NDArray[np.float64]

MOST_FRAMES = 4  # Doubtful frames that a person in a hurry looks at
BETTER = 0.85  # What is left of a pose's error where a person sees that another one is better
SAME_M = 1e-3  # Change of that distance that is none
RIGHT_M = 0.1  # Mean distance of the joints, with hips aligned, at which a person is content
LIMBS = {"elbow.L": "wrist.L", "elbow.R": "wrist.R", "knee.L": "ankle.L", "knee.R": "ankle.R"}
"""The joint over which a limb is flipped, and the one that shows most where the limb is."""


def doubtful(person: Person) -> Steps[None]:
    """Go from one doubtful frame to the next, and decide each; at least the least sure one."""
    before = len(person.state.doubtful)
    for number in range(MOST_FRAMES):
        waiting = person.state.doubtful
        if not waiting and number:
            break
        if not waiting:  # whoever finds none looks at the least sure one
            matches = person.take.matching.matches
            person.take.matching.shown_match = min(range(len(matches)), key=lambda i: matches[i].confidence)
            person.step_done("Choose the least sure in the list")
        elif person.take.matching.shown_match not in waiting:
            yield from person.hands.click_button("keymark.jump_to_match", "only_doubtful=True")
        yield from _decide(person)
        if number == 0:
            yield from person.look("decided")
    left = len(person.state.doubtful)
    print(f"{before} keyframes were doubtful, {left} are", flush=True)
    expect(before == 0 or left < before, f"of {before} doubtful keyframes {left} are left")
    yield from person.look("corrected")


def _decide(person: Person) -> Steps[None]:
    """Choose the best candidate, turn and flip where that helps, each keyed at once, or accept the frame."""
    matching, hands = person.take.matching, person.hands
    match = matching.matches[matching.shown_match]
    frame, done = round(match.frame), [f"{_error(person):.2f} m"]
    errors = [_error(person, _points(person, candidate)) for candidate in match.candidates]
    best = int(np.argmin(errors))
    if best != match.chosen and errors[best] < BETTER * errors[match.chosen]:
        yield from hands.click_button("keymark.replace_match", f"candidate={best}")
        done.append(f"candidate {best + 1}: {_error(person):.2f} m")
    facing = _facing(person, performer(person))
    if facing != _facing(person, _shown(person)):
        kept = yield from _turned(person, facing)
        done += [f"turned: {_error(person):.2f} m"] * kept
    wrong = [joint for joint, end in LIMBS.items() if _off(person, end) > 2.0 * RIGHT_M]
    if wrong and _error(person) > RIGHT_M:
        flipped = yield from _flipped(person, wrong)
        done += [f"flipped {' and '.join(flipped)}: {_error(person):.2f} m"] * bool(flipped)
    if len(done) == 1:
        yield from hands.click_button("keymark.accept_match")
    print(f"Frame {frame}: {', '.join(done)}", flush=True)
    now = person.state.doubtful
    decided = all(round(person.take.matching.matches[index].frame) != frame for index in now)
    expect(decided, f"frame {frame} is doubtful still")


def _turned(person: Person, facing: str) -> Steps[bool]:
    """Choose where the performer faces from the menu; taken back where that is no better."""
    before = _error(person)
    person.hands.clicks += 2  # the button that opens the menu, and the entry
    yield from person.hands.invoke("keymark.turn_performer", facing=facing)
    return (yield from _kept(person, before))


def _flipped(person: Person, joints: list[str]) -> Steps[list[str]]:
    """Press F over joints while they can be dragged; those remain whose flip is kept."""
    kept = []
    yield from person.hands.click_button("keymark.drag_joints")
    yield from until(lambda: person.jobs(), "the tool")
    for joint in joints:
        before = _error(person)
        yield from person.hands.move(*seen(person, joint))
        yield from person.hands.press("F")
        if (yield from _kept(person, before)):
            kept.append(joint)
    yield from person.hands.press("RET")
    yield from until(lambda: not person.jobs(), "the tool to end")
    return kept


def _kept(person: Person, before: float) -> Steps[bool]:
    """Whether the pose is better than `before` [m]; undone where it is another and no better."""
    yield from turns(2)
    now = _error(person)
    if now >= BETTER * before and abs(now - before) > SAME_M:
        yield from person.hands.undo()
        left = abs(_error(person) - before)
        expect(left < SAME_M, f"undoing leaves a pose that is {left:.3f} m off")
    return now < BETTER * before


def performer(person: Person) -> Points:
    """Where the performer's joints (13, 3) are in the current frame [m]."""
    known = person.known
    read_truth = keymark("core.review.score").read_truth
    truth = read_truth(known.folder / "truth.json", known.frame_start, person.take.clip.frame_duration)
    points: Points = truth[person.scene.frame_current - known.frame_start]
    return points


def _shown(person: Person) -> Points:
    return np.array(keymark("operators.bridge.actor_bones").joint_places(person.take.armature))


def _points(person: Person, candidate: Any) -> Points:
    posture = keymark("operators.bridge.keyframes").candidate_posture(candidate)
    points: Points = person.known.body.points(person.known.body.pose(posture))
    return points


def _rooted(points: Points) -> Points:
    return points - 0.5 * (points[_row("hip.L")] + points[_row("hip.R")])


def _error(person: Person, points: Points | None = None) -> float:
    """Mean distance of joints, the actor's by default, from the performer's, with hips aligned [m]."""
    shown = _shown(person) if points is None else points
    return float(np.linalg.norm(_rooted(shown) - _rooted(performer(person)), axis=-1).mean())


def _off(person: Person, joint: str) -> float:
    """How far one of the actor's joints is from the performer's, with hips aligned [m]."""
    apart = _rooted(_shown(person)) - _rooted(performer(person))
    return float(np.linalg.norm(apart[_row(joint)]))


def _facing(person: Person, points: Points) -> str:
    """Where a figure faces in the picture, as the menu names it."""
    left = points[_row("hip.L")] - points[_row("hip.R")] + points[_row("shoulder.L")]
    left -= points[_row("shoulder.R")]
    ahead = np.array([left[1], -left[0]])
    matrix = np.array(person.known.camera.matrix_world)
    toward = matrix[:2, 3] - points[:, :2].mean(axis=0)
    toward /= np.linalg.norm(toward)
    right = np.array([-toward[1], toward[0]])
    along, aside = float(ahead @ toward), float(ahead @ right)
    if abs(along) >= abs(aside):
        return "CAMERA" if along > 0.0 else "AWAY"
    return "RIGHT" if aside > 0.0 else "LEFT"


def _row(joint: str) -> int:
    return tuple(keymark("core.body.human").HUMAN.point_names).index(joint)
