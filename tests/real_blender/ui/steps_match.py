"""A session's middle without posing: found keyframes, a choice among candidates, and the motion."""

from driver import Steps, expect, turns
from person import Person
from steps_finish import shown_points, write_points
from steps_reconstruct import cancelled, job

OTHER = 1  # Candidate that is tried instead of the first one


def match(person: Person, library: str) -> Steps[None]:
    """Find poses with a named library alone, and think better of it."""
    matching = person.take.matching
    matching.library = library
    person.step_done("Choose the library")
    yield from person.undoable("finding poses with it", lambda: job(person, "keymark.pose_all"))
    expect(len(person.take.matching.matches) >= 2, f"{library} gave too few keyframes")
    expect(not person.state.posed, "frames count as posed that nobody posed")
    yield from person.look("matched")
    yield from person.undoable("removing what was found", lambda: person.hands.invoke("keymark.remove_found"))
    expect(not person.state.keyed.all, "found keyframes are left")
    person.take.matching.library = "auto"
    person.step_done("Choose all libraries")


def pose_all(person: Person) -> Steps[None]:
    """Pose all proposed frames by one button, cancelled by Esc once."""
    name = "keymark.pose_all"
    yield from person.changes_nothing("cancelling Pose All", lambda: cancelled(person, name))
    yield from person.undoable("posing all", lambda: job(person, name))
    found = person.state.matched
    expect(len(found) >= 2, f"keyframes were found at {found}")
    expect(not person.state.unposed, "proposed frames are left without a pose")
    expect(not person.state.posed, "frames count as posed that nobody posed")
    yield from person.look("posed_all")


def choose(person: Person) -> Steps[None]:
    """Look at a doubtful frame from the side, take another candidate, and think better of it."""
    count, doubtful = person.state.found_count, person.state.doubtful
    if doubtful:
        yield from person.hands.click_button("keymark.jump_to_match", "only_doubtful=True")
    else:
        person.take.matching.shown_match = 1
        person.step_done("Choose a found keyframe in the list")
    match = person.take.matching.matches[person.take.matching.shown_match]
    expect(person.scene.frame_current == round(match.frame), "the chosen frame is not shown")
    yield from person.hands.click_button("keymark.look_from_side")
    yield from turns(5)
    yield from person.look("from_the_side")
    if len(match.candidates) > OTHER:
        yield from person.undoable("taking a candidate", lambda: _take(person, OTHER))
        yield from person.look("replaced")
        yield from _take(person, 0)
    yield from person.hands.click_button("keymark.look_from_side")
    left = person.state.found_count
    expect(left == count, f"of {count} found keyframes {left} are left")


def reconstruct(person: Person) -> Steps[None]:
    yield from person.undoable("reconstructing", lambda: job(person, "keymark.reconstruct"))
    yield from person.look("unposed")
    points = yield from shown_points(person)
    write_points(person, "motion.json", points)


def _take(person: Person, candidate: int) -> Steps[None]:
    yield from person.hands.click_button("keymark.replace_match", f"candidate={candidate}")
