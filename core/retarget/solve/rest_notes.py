"""What a rest pose says against its map."""

from ...body.skeleton import SIDES
from .rest_body import RestBody

CLEARLY = 0.05
"""Share of the leg's length by which toes lie clearly behind their ankle."""


def rest_notes(body: RestBody) -> tuple[str, ...]:
    """Sentences without a full stop on a rest pose that the map cannot mean."""
    roles = [(f"foot.{side}", f"toe.{side}") for side in SIDES]
    behind = [float(body.joint(toe)[1] - body.joint(foot)[1]) for foot, toe in roles if toe in body.first]
    if behind and min(behind) > CLEARLY * body.leg_m:
        return (
            (
                f"The toes of '{body.character.name}' point backward by its character map; left and "
                "right may be mistaken for each other there"
            ),
        )
    return ()
