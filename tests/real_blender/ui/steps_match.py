"""A session's middle without posing: keyframes from a library, one of them replaced, and the motion."""

from driver import Steps, expect
from person import Person, keymark
from steps_finish import shown_points, write_points
from steps_reconstruct import cancelled, job

REPLACED = 1
"""Place in the list of the match that is replaced."""


def match(person: Person, library: str) -> Steps[None]:
    """Match a library, cancelled by Esc once; replace a match, and think better of it."""
    name = "keymark.match_library"
    person.take.matching.library = library
    person.step_done("Choose the library")
    yield from person.changes_nothing("cancelling the match", lambda: cancelled(person, name))
    yield from person.undoable("matching", lambda: job(person, name))
    matches = person.take.matching.matches
    expect(len(matches) >= 2, f"{library} gave {len(matches)} matches")
    frames = keymark("operators.shell.keyed_frames")
    expect(not frames.posed_frames(person.take), "frames count as posed that nobody posed")
    yield from person.look("matched")
    person.take.matching.active_match = REPLACED
    person.step_done("Choose a match")
    expect(person.scene.frame_current == round(matches[REPLACED].frame), "choosing does not go there")
    yield from person.undoable("replacing a match", lambda: _replace(person, 1))
    expect(person.take.matching.matches[REPLACED].chosen == 1, "the other posture is not chosen")
    yield from person.look("replaced")
    yield from _replace(person, 0)
    expect(len(frames.matched_frames(person.take)) == len(person.take.matching.matches), "a match is lost")


def reconstruct(person: Person) -> Steps[None]:
    """The motion, from keyframes that nobody has posed."""
    yield from person.undoable("reconstructing", lambda: job(person, "keymark.reconstruct"))
    yield from person.look("unposed")
    points = yield from shown_points(person)
    write_points(person, "motion.json", points)


def _replace(person: Person, candidate: int) -> Steps[None]:
    yield from person.hands.click_button("keymark.replace_match", f"candidate={candidate}")
