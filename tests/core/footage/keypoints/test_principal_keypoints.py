"""The principal points as keypoints of any layout and of several sources show them."""

import numpy as np
from keymark.core.body.human import HUMAN, TRUNK, limb_of
from keymark.core.body.skeleton import SIDES
from keymark.core.footage.keypoints.keypoints import Keypoints
from keymark.core.footage.keypoints.performer import performer_size_px, principal_keypoints

HEAD, WRIST = HUMAN.point_names.index("head"), HUMAN.point_names.index("wrist.L")


def seen(points: dict[str, tuple[float, float]], score: float = 0.9) -> Keypoints:
    pixel = np.array([list(points.values())])
    shape = pixel.shape[:2]
    sources = (f"sure to {score}",) * len(points)
    return Keypoints(tuple(points), sources, pixel, np.full(shape, score), np.full((*shape, 3), np.nan))


def test_the_heads_center_is_halfway_between_the_ears() -> None:
    """The nose, a decimeter in front of it, counts where the ears are hidden, and for less."""
    face = {"nose": (50.0, 20.0), "ear.L": (60.0, 10.0), "ear.R": (40.0, 12.0)}
    both, nose = principal_keypoints(seen(face)), principal_keypoints(seen({"nose": (50.0, 20.0)}))
    np.testing.assert_allclose(both.pixel[0, HEAD], [50.0, 11.0])
    np.testing.assert_allclose(nose.pixel[0, HEAD], [50.0, 20.0])
    assert nose.score[0, HEAD] < 0.5 * both.score[0, HEAD]
    own = principal_keypoints(seen({"head": (7.0, 8.0), **face}))
    np.testing.assert_allclose(own.pixel[0, HEAD], [7.0, 8.0])


def test_sources_that_agree_are_averaged_and_a_lone_one_that_does_not_is_left_out() -> None:
    first = seen({"wrist.L": (10.0, 0.0), "ankle.L": (0.0, 100.0)}, 0.8)
    near, far = seen({"wrist.L": (14.0, 0.0)}, 0.4), seen({"wrist.L": (40.0, 0.0)}, 0.4)
    with_near = principal_keypoints(Keypoints.side_by_side([first, near], 1))
    with_far = principal_keypoints(Keypoints.side_by_side([far, first], 1))
    np.testing.assert_allclose(with_near.pixel[0, WRIST], [(0.8 * 10.0 + 0.4 * 14.0) / 1.2, 0.0])
    np.testing.assert_allclose(with_far.pixel[0, WRIST], [10.0, 0.0])
    assert with_far.score[0, WRIST] == 0.8


def test_what_nothing_shows_is_missing() -> None:
    found = principal_keypoints(seen({"wrist.L": (10.0, 0.0)}))
    assert found.seen.sum() == 1
    assert not principal_keypoints(Keypoints.none(4)).seen.any()
    np.testing.assert_array_equal(performer_size_px(Keypoints.none(4)), np.zeros(4))


def test_every_segment_and_point_belongs_to_a_part_of_the_body() -> None:
    names = [*(segment.name for segment in HUMAN.segments), *HUMAN.point_names]
    found = {limb_of(name) for name in names}
    assert found == {TRUNK, *(f"{limb}.{side}" for limb in ("arm", "leg") for side in SIDES)}
    assert limb_of("shoulder.L") == limb_of("hip.R") == limb_of("nose") == TRUNK
    assert limb_of("toe.R") == "leg.R"
