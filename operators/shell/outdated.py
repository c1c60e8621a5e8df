"""What a new motion makes outdated: the one place that knows, for every step that makes one."""

import bpy


def reconstructed_again(take: bpy.types.PropertyGroup) -> None:
    """Note that the take's motion is newer than what was made from it."""
    take.finish.outdated = take.finish.action is not None
    finished_again(take)


def finished_again(take: bpy.types.PropertyGroup) -> None:
    """Note that the take's final Action is newer than the characters' motions."""
    for character in take.characters:
        for result in character.results:
            if result.source in ("FINAL", "MOTION"):  # not those of other Actions
                result.outdated = result.action is not None
