"""Poses that a fitted frame offers, and what contradicts there, for as long as it is true."""

from collections.abc import Iterator

import bpy
import numpy as np
import pytest
from _posed import posture_of
from keymark.operators.shell.contradictions import contradictions_at, note_contradictions
from keymark.operators.shell.keyed_frames import offered_at, posed_frames
from keymark.operators.shell.takes import active_take

pytestmark = pytest.mark.usefixtures("registered")


@pytest.fixture
def fitted(opened: bpy.types.Scene) -> Iterator[bpy.types.Scene]:
    """A take with a frame between keyframes fitted from nothing."""
    opened.frame_set(4)
    assert bpy.ops.keymark.fit_pose(start="ANEW") == {"FINISHED"}
    yield opened


def test_a_fitted_frame_offers_other_poses_and_keys_none(fitted: bpy.types.Scene) -> None:
    """The likeliest is shown; another one at a click; elsewhere there is nothing to choose."""
    take = active_take(fitted)
    offered = offered_at(take, 4.0)
    assert offered is not None and offered.chosen == 0
    assert 4.0 not in posed_frames(take)
    first = posture_of(fitted)
    assert bpy.ops.keymark.show_offered(candidate=1) == {"FINISHED"}
    assert np.abs(posture_of(fitted).minus(first)).max() > 0.05
    assert offered_at(take, 4.0).chosen == 1
    assert bpy.ops.keymark.show_offered(candidate=0) == {"FINISHED"}
    np.testing.assert_allclose(posture_of(fitted).minus(first), 0.0, atol=1e-4)
    assert offered_at(take, 5.0) is None
    with pytest.raises(RuntimeError, match="candidate must be 0 to"):
        bpy.ops.keymark.show_offered(candidate=9)


def test_storing_the_pose_ends_the_choice(fitted: bpy.types.Scene) -> None:
    """A posed frame offers nothing, and nothing contradicts it."""
    take = active_take(fitted)
    note_contradictions(take, 4.0, ("trunk",))
    bpy.ops.keymark.store_keyframe()
    assert offered_at(take, 4.0) is None
    assert contradictions_at(take, 4.0) == ()
    with pytest.raises(RuntimeError, match="offers no poses"):
        bpy.ops.keymark.show_offered(candidate=0)


def test_what_contradicts_is_kept_until_the_frame_is_fitted_otherwise(fitted: bpy.types.Scene) -> None:
    """It is there on coming back to the frame, and undo brings it back."""
    take = active_take(fitted)
    name = take.markers[0].name
    note_contradictions(take, 4.0, (name,))
    bpy.ops.ed.undo_push(message="noted")
    fitted.frame_set(1)
    fitted.frame_set(4)
    assert contradictions_at(take, 4.0) == (name,)
    bpy.ops.keymark.fit_pose(start="ANEW")
    assert contradictions_at(active_take(fitted), 4.0) == ()
    bpy.ops.ed.undo_push(message="fitted")
    bpy.ops.ed.undo()
    assert contradictions_at(active_take(bpy.context.scene), 4.0) == (name,)


def test_a_pose_that_is_only_brought_nearer_offers_no_other(opened: bpy.types.Scene) -> None:
    """Whoever has set a pose wants that one."""
    opened.frame_set(4)
    bpy.ops.keymark.fit_pose(start="POSE")
    assert offered_at(active_take(opened), 4.0) is None
