"""Sentences remember their templates and values, also as errors, in copies and where a value has braces."""

import copy
import pickle

import pytest
from keymark.core.errors import InputError
from keymark.core.text import Sentence


def test_a_sentence_is_its_text_with_what_it_was_made_of() -> None:
    """It stands wherever text does; braces in a value, as in a file's name, are not filled in."""
    said = Sentence("{file}: has {count:g} of {{all}}", file="a{0}.json", count=2.0)
    assert said == "a{0}.json: has 2 of {all}"
    assert said.template == "{file}: has {count:g} of {{all}}"
    assert said.values == {"file": "a{0}.json", "count": 2.0}


@pytest.mark.parametrize("again", [copy.deepcopy, lambda said: pickle.loads(pickle.dumps(said))])
def test_copies_remember_as_well(again: object) -> None:
    """Deep copies, and what goes to another process."""
    said = Sentence("{file}: is {{empty}}", file="{x}")
    made = again(said)  # type: ignore[operator]
    assert (made, made.template, made.values) == (said, said.template, said.values)


def test_an_error_is_a_sentence_where_it_has_values() -> None:
    """A text without values is taken as it is, whatever braces it has."""
    error = InputError("take '{take}' has no clip", take="walk")
    assert str(error) == "take 'walk' has no clip" == error.sentence
    assert isinstance(error.sentence, Sentence)
    assert str(InputError("it must be {...}")) == "it must be {...}"
    assert str(InputError("{sentence}, again", sentence="no")) == "no, again"
