"""Fields of a JSON object: numbers that no float can hold are refused as wrong ones are."""

from typing import Any

import pytest
from keymark.core.body.actor import Actor
from keymark.core.errors import InputError
from keymark.core.files.fields import Fields

NO_FLOAT_HOLDS_IT = 10**400


@pytest.mark.parametrize("value", [NO_FLOAT_HOLDS_IT, -NO_FLOAT_HOLDS_IT, float("inf"), float("nan"), True])
def test_what_is_no_number_of_the_range_is_refused_in_one_sentence(value: Any) -> None:
    """Alone, whole, and in a list."""
    fields = Fields({"size": value}, "a.json")
    for read in (
        lambda: fields.number("size", 0.0, 3.0),
        lambda: fields.integer("size", 0, 3),
        lambda: Fields({"size": [value]}, "a.json").numbers("size", 1, 0.0, 3.0, "a list of one number"),
    ):
        with pytest.raises(InputError, match=r"a\.json: size is .*; it must be a") as refusal:
            read()
        assert len(str(refusal.value)) < 200


def test_a_length_of_the_body_no_float_holds_is_refused() -> None:
    """The actor's check is the fields' own."""
    with pytest.raises(InputError, match=r"actor\.segments_m\.trunk is 1000"):
        Actor({**Actor.from_stature(1.8).segments_m, "trunk": NO_FLOAT_HOLDS_IT})
