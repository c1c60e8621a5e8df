"""A take as its footage shows it: what poses and motions are made of, told once for all of them."""

from dataclasses import dataclass, replace

from ..arrays import BoolArray
from ..body.skeleton import SIDES
from ..detect.keypoints import Keypoints
from ..markers.reading import Reading
from .performer_keypoints import performer_keypoints
from .presence import presence, unseen_ends, unseen_limbs
from .reference import seen_reference
from .take import Take


@dataclass(frozen=True, eq=False)
class SeenTake:
    """A take, the reading of its clip, and the performer in it."""

    take: Take
    """With its keypoints as the pictures say they are meant, seen as by a camera that stands still."""
    reading: Reading
    """As that camera sees the clip."""
    keypoints: Keypoints
    """The performer's."""
    there: BoolArray
    """(F,) frames in which the performer is there."""
    unseen: tuple[str, ...]
    """Limbs that are never seen."""
    unseen_ends: tuple[str, ...] = ()
    """Hands and feet of the same, of limbs that are seen; none where markers or poses tell of them."""
    camera_notes: tuple[str, ...] = ()
    """A sentence on a camera that moves and is not followed."""

    @property
    def feet_seen(self) -> tuple[bool, bool]:
        """Whether the left and the right foot are ever seen: those that are not tell no floor."""
        unseen = {*self.unseen, *self.unseen_ends}
        left, right = (not unseen & {f"leg.{side}", f"foot.{side}"} for side in SIDES)
        return left, right


def seen_take(take: Take, reading: Reading, camera_notes: tuple[str, ...] = ()) -> SeenTake:
    """Tell the performer from everybody else, and when which of his limbs are seen."""
    keypoints = performer_keypoints(take, reading.tracks)
    reference, keypoints = seen_reference(keypoints, take.keypoints)
    take = replace(take, reference=take.reference or reference)
    there = presence(take, reading, keypoints)
    unseen = unseen_limbs(take, reading.tracks, keypoints, there)
    is_told = take.markers or any(key.is_posed for key in take.keyframes)
    ends = () if is_told else unseen_ends(keypoints, there, unseen)
    return SeenTake(take, reading, keypoints, there, unseen, ends, camera_notes)
