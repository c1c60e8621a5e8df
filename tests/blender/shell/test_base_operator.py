"""The base of operators: requirements as tooltips, failures as reports, and what counts as an undo step."""

from types import SimpleNamespace

import bpy
import pytest
from keymark.core.errors import InputError
from keymark.operators.shell.base_operator import BaseOperator, Unchanged, remove_active
from keymark.operators.shell.job_operator import cancel_click, cancel_job

CONTEXT = SimpleNamespace(scene=SimpleNamespace(keymark=SimpleNamespace(takes=())))


class Operator(BaseOperator):
    """An operator outside Blender that returns or raises what it is given."""

    tooltips: list[str]

    def __init__(self, outcome: set[str] | Exception | None = None) -> None:
        self.outcome = outcome
        self.reports: list[tuple[set[str], str]] = []
        self.cancelled = 0

    @classmethod
    def poll_message_set(cls, sentence: str) -> None:
        cls.tooltips.append(sentence)

    def report(self, kind: set[str], text: str) -> None:
        self.reports.append((kind, text))

    def run(self, context: bpy.types.Context) -> set[str] | None:
        if isinstance(self.outcome, Exception):
            raise self.outcome
        return self.outcome

    def cancel(self, context: bpy.types.Context) -> None:
        self.cancelled += 1


def test_the_first_unmet_requirement_is_the_tooltip() -> None:

    class Demanding(Operator):
        tooltips = []
        requirements = (lambda *_: None, lambda *_: "Load it", lambda *_: "Save it")

    assert not Demanding.poll(CONTEXT)
    assert Demanding.tooltips == ["Load it"]
    assert Operator.poll(CONTEXT)


@pytest.mark.parametrize(("outcome", "result"), [(None, {"FINISHED"}), ({"CANCELLED"}, {"CANCELLED"})])
def test_an_operator_that_did_nothing_is_cancelled(outcome: set[str] | None, result: set[str]) -> None:
    operator = Operator(outcome)
    assert operator.execute(CONTEXT) == result
    assert operator.reports == []


def test_an_expected_failure_is_a_report_and_any_other_passes_through() -> None:
    operator = Operator(InputError("the clip is upside down"))
    assert operator.execute(CONTEXT) == {"CANCELLED"}
    assert operator.reports == [({"ERROR"}, "The clip is upside down")]
    missing = Operator(ModuleNotFoundError("No module named 'scipy.linalg'", name="scipy.linalg"))
    assert missing.execute(CONTEXT) == {"CANCELLED"}
    assert "needs the Python library scipy, " in missing.reports[0][1]
    idle = Operator(Unchanged("all is posed"))
    assert idle.execute(CONTEXT) == {"CANCELLED"} and idle.reports == [({"INFO"}, "All is posed")]
    with pytest.raises(ZeroDivisionError):
        Operator(ZeroDivisionError()).execute(CONTEXT)


def test_an_operator_is_named_after_its_class() -> None:

    class KEYMARK_OT_load_it(Operator):  # noqa: N801
        pass

    assert KEYMARK_OT_load_it.bl_idname == "keymark.load_it"
    assert KEYMARK_OT_load_it.bl_options == {"REGISTER", "UNDO"}


@pytest.mark.parametrize(("active", "left", "then"), [(0, "bc", 0), (2, "ab", 1), (7, "ab", 1)])
def test_the_entry_before_a_removed_one_is_active(active: int, left: str, then: int) -> None:
    entries = list("abc")
    kind = type("Names", (), {"__len__": lambda _: len(entries), "remove": lambda _, i: entries.pop(i)})
    owner = SimpleNamespace(names=kind(), active=active)
    remove_active(owner, "names", "active")
    assert ("".join(entries), owner.active) == (left, then)


@pytest.mark.parametrize(
    ("kind", "value", "job", "click"),
    [
        ("ESC", "PRESS", True, True),
        ("ESC", "RELEASE", False, False),
        ("RIGHTMOUSE", "PRESS", False, True),
        ("LEFTMOUSE", "PRESS", False, False),
    ],
)
def test_esc_cancels_and_a_right_click_cancels_a_click(kind: str, value: str, job: bool, click: bool) -> None:
    event = SimpleNamespace(type=kind, value=value)
    working, waiting = Operator(), Operator()
    assert cancel_job(working, CONTEXT, event) is job
    assert cancel_click(waiting, CONTEXT, event) is click
    assert (working.cancelled, waiting.cancelled) == (job, click)
    assert working.reports == ([({"INFO"}, "Cancelled")] if job else [])
    assert waiting.reports == []
