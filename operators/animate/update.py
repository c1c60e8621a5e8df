"""*Update*: what was corrected becomes the motion, and all that was made of the earlier one is made anew."""

from typing import TYPE_CHECKING

import bpy

from ...core.progress import Progress, stretch
from ..character.retarget import keep_retargeted, retarget_take
from ..finish.bake_motion import bake, keep_baked
from ..reconstruct.reconstruct import PreviewedJob, keep_motion, reconstruct_take
from ..shell.requirements import actor, all_colors, anything_to_follow, footage, idle, of_take, two_keyframes
from ..shell.take_state import TakeState
from ..shell.takes import active_take

if TYPE_CHECKING:
    from ...core.progress import Job

outdated = of_take(lambda state: state.is_outdated, "Everything is up to date")


def update_take(operator: PreviewedJob, scene: bpy.types.Scene) -> "Job[list[str]]":
    """Make anew what is outdated of the active take, each part in the scene once it is complete.

    Returns:
        A line on each part.
    """
    said = []
    if TakeState(active_take(scene)).motion_is_outdated:
        made, judged = yield from stretch(reconstruct_take(operator, scene), 0.0, 0.6)
        operator.unwatch()  # the motion takes the place of its preview
        said.append(keep_motion(operator, scene, made, judged))
    if TakeState(active_take(scene)).final_is_outdated:
        said.append(keep_baked(operator, scene, (yield from stretch(bake(scene), 0.6, 0.7))))
    chosen, count = active_take(scene).active_character, len(active_take(scene).characters)
    for index in range(count):
        take = active_take(scene)
        if any(map(TakeState(take).of_earlier, take.characters[index].results)):
            take.active_character = index
            start, end = (0.7 + 0.3 * at / count for at in (index, index + 1))
            said.append(
                keep_retargeted(operator, scene, (yield from stretch(retarget_take(scene), start, end)))
            )
    active_take(scene).active_character = chosen
    yield Progress("Updated", 1.0)
    return said


class StagedOperator(PreviewedJob):
    """Mixin of a job that writes what is complete into the scene on its way, and returns lines on it."""

    def finish(self, scene: bpy.types.Scene, result: list[str]) -> None:
        """Report the lines."""
        for line in result:
            self.report({"INFO"}, line)

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """An early end is a step that can be undone as well: complete stages stay."""
        done = super().modal(context, event)
        if done != {"CANCELLED"}:
            return done
        self.report({"INFO"}, "The stages that were complete are kept")
        return {"FINISHED"}


class KEYMARK_OT_update(StagedOperator, bpy.types.Operator):
    """Make the motion of your corrections, and bake and retarget it again where that was done before"""

    bl_label = "Update"
    requirements = (outdated, footage, actor, anything_to_follow, all_colors, two_keyframes, idle)

    def start(self, scene: bpy.types.Scene) -> "Job[list[str]]":
        return (yield from update_take(self, scene))
