"""Fields of a JSON object: numbers that no float can hold are refused as wrong ones are."""

from typing import Any

import pytest
from keymark.core.body.actor import Actor
from keymark.core.errors import InputError
from keymark.core.files.kinds import Items, Number, Whole

NO_FLOAT_HOLDS_IT = 10**400


@pytest.mark.parametrize("value", [NO_FLOAT_HOLDS_IT, -NO_FLOAT_HOLDS_IT, float("inf"), float("nan"), True])
def test_what_is_no_number_of_the_range_is_refused_in_one_sentence(value: Any) -> None:
    one = Number(0.0, 3.0)
    kinds = (one, Whole(0, 3), Items("numbers", 1, 1, "a list of one number", item=one))
    for kind, given in zip(kinds, (value, value, [value]), strict=True):
        with pytest.raises(InputError, match=r"a\.json: size is .*; it must be a") as refusal:
            kind.read(given, "a.json", "size")
        assert len(str(refusal.value)) < 200


def test_a_length_of_the_body_no_float_holds_is_refused() -> None:
    with pytest.raises(InputError, match=r"actor\.segments_m\.trunk is 1000"):
        Actor({**Actor.from_stature(1.8).segments_m, "trunk": NO_FLOAT_HOLDS_IT})
