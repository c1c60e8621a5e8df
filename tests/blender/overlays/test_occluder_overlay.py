"""The overlay of what stands before the performer."""

from dataclasses import replace
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from _review import made_up_review
from keymark.operators.overlays import motion, occluders
from keymark.operators.overlays.legend import Sample
from keymark.operators.overlays.occluders import EDGE, TINT, tinted
from keymark.operators.shell import takes


def test_what_hides_is_tinted_within_a_dark_edge_and_nothing_else() -> None:
    """The picture's own border is no edge; a half as opaque overlay is half as opaque."""
    covered = np.zeros((12, 16), dtype=bool)
    covered[6:, 4:12] = True
    picture = tinted(covered, 1.0)
    assert picture[:6].max() == 0.0 and picture[:, :4].max() == 0.0
    assert picture[6, 8] == pytest.approx(EDGE) and picture[9, 4] == pytest.approx(EDGE)
    assert picture[9, 8] == pytest.approx(TINT) and picture[11, 8] == pytest.approx(TINT)
    assert tinted(covered, 0.5)[9, 8, 3] == pytest.approx(0.5 * TINT[3])


@pytest.fixture
def painted(registered: None, monkeypatch: pytest.MonkeyPatch) -> list[np.ndarray]:
    """The pictures that are painted over the footage, of a scene with a take and a motion."""
    review = replace(made_up_review(), marker_names=("trunk", "shin.L"))
    takes.add_take(bpy.context.scene, "Take")
    for module in (motion, occluders):
        monkeypatch.setattr(module, "review_of", lambda take: review)
    monkeypatch.setattr(occluders, "footage_view", lambda *where: SimpleNamespace())
    monkeypatch.setattr(occluders.drawing, "texture", lambda picture: picture)
    monkeypatch.setattr(occluders, "_drawn", {})
    pictures: list[np.ndarray] = []
    monkeypatch.setattr(occluders, "draw_picture", lambda picture, view: pictures.append(picture))
    return pictures


def test_the_switch_hides_it_and_the_picture_is_made_once(painted: list[np.ndarray]) -> None:
    """A redraw does not make the texture anew; another opacity does."""
    settings = bpy.context.scene.keymark.overlays
    context = SimpleNamespace(scene=bpy.context.scene, area=None, region=None)
    for _ in range(2):
        occluders.draw(context)
    settings.opacity = 0.5
    occluders.draw(context)
    assert len(painted) == 3 and painted[0] is painted[1] and painted[2] is not painted[1]
    settings.show_occluders = False
    occluders.draw(context)
    assert len(painted) == 3


def test_the_legend_names_the_tint(painted: list[np.ndarray]) -> None:
    """Only while it is shown."""
    scene = bpy.context.scene
    what = motion.shown(scene)
    assert what is not None
    view = SimpleNamespace(footage=SimpleNamespace())
    row = (Sample.NONE, "Tinted: stands before the performer")
    assert row in motion._rows(what, view, scene.keymark.overlays, ())
    scene.keymark.overlays.show_occluders = False
    assert row not in motion._rows(what, view, scene.keymark.overlays, ())
