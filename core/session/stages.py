"""The way of a take, stage by stage: all that is made of a clip goes along this list, up to its stage."""

from collections.abc import MutableMapping

from ..markers.reading import Reading
from ..progress import Job, run
from ..take.presence import SeenTake
from ..take.take import Take
from .place import PLACE
from .pose import POSE, RECONSTRUCT
from .see import READ, SEE
from .session import Inputs, Keep, Session, Stage, advance, keep_nothing, placed_take


def _by_bridge(name: str, work: float) -> Stage:
    """A stage that only Blender can do, as the inputs say how: for it the take's bones are in a scene."""

    def through(session: Session) -> Job[object]:
        return (yield from session.inputs.bridge[name](session)) if name in session.inputs.bridge else None

    return Stage(name, through, None, lambda inputs: work if name in inputs.bridge else 0.0)


STAGES = (
    READ,
    SEE,
    PLACE,
    POSE,
    RECONSTRUCT,
    _by_bridge("finish", 0.4),
    _by_bridge("retarget", 0.9),
)


def reach(
    session: Session,
    last: str,
    kept: MutableMapping[str, object] | None = None,
    keep: Keep = keep_nothing,
) -> Job[Session]:
    """The session with all stages up to `last`; see `advance`.

    Raises:
        InputError: The clip or anything else of the take cannot be used.
        ConversionError: No motion could be computed.
    """
    names = [stage.name for stage in STAGES]
    return advance(session, STAGES[: names.index(last) + 1], kept, keep)


def seen_in(take: Take, reading: Reading, kept: MutableMapping[str, object] | None = None) -> SeenTake:
    """A take as a reading of its clip shows it; `kept` as in `advance`."""
    return placed_take(run(reach(Session(Inputs(take), {"read": reading}, reading.key), "place", kept)))
