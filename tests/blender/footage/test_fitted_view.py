"""Which views of the footage may be fitted beside a sidebar again."""

from keymark.operators.footage.camera_view import is_same, may_move


def test_a_view_that_a_person_has_moved_stays() -> None:
    """One that was fitted, or that Blender has centered, does not; single precision makes no difference."""
    fitted = (15.333744, 0.0502002, 0.0191536)
    assert may_move((15.3337440490, 0.0502002276, 0.0191536434), fitted)
    assert may_move((0.0, 0.0, 0.0), None) and may_move((8.0, 0.0, 0.0), fitted)
    assert not may_move((15.333744, 0.2, 0.1), fitted)
    assert not may_move((29.0, 0.0502002, 0.0191536), fitted)
    assert not may_move(fitted, None)
    assert is_same(fitted, (15.3337440490, 0.0502002276, 0.0191536434))
