"""Text with units: values, refusals and messages."""

import math

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic_core import PydanticCustomError

from damperopt.quantities.units import Quantity


@pytest.mark.parametrize(
    ("unit", "text", "value"),
    [
        ("m", "600 mm", 0.6),
        ("m", "1 ft", 0.3048),
        ("m/s", "120 kt", 120 * 1852 / 3600),
        ("rad", "180 deg", math.pi),
        ("Pa", "200 GPa", 2e11),
        ("Pa", "3000 psi", 3000 * 4.4482216152605 / 0.0254**2),
        ("N", "150 kN", 150e3),
        ("N m/rad", "380 kN m/rad", 3.8e5),
        ("kg m^2", "1 slug ft^2", 14.593902937206 * 0.3048**2),
        ("m^4", "3.4 cm^4", 3.4e-8),
        ("kg/m^3", "7850 kg/m3", 7850.0),
        ("N m^2/rad", "570 N m2/rad", 570.0),
        ("1/s", "0.1 1/s", 0.1),
        ("1/rad", ".5 1/rad", 0.5),
        ("1", 0.25, 0.25),
        ("m", 1, 1.0),
    ],
)
def test_text_with_a_unit_becomes_si(unit, text, value):
    assert Quantity(unit)(text) == pytest.approx(value, rel=1e-15)


@pytest.mark.parametrize(
    ("unit", "found", "says"),
    [
        ("m", "5 kg", "another dimension"),
        ("m", "5 parsnips", "unknown"),
        ("m", "five m", "not a number with a unit"),
        ("m", "1e5", "without a unit"),
        ("m", "", "not a number"),
        ("m", True, "found True"),
        ("m", None, "found nothing"),
        ("m", [1.0], "found a list"),
        ("m", {"a": 1}, "found a mapping"),
        ("m", math.nan, "not a finite number"),
        ("m", math.inf, "not a finite number"),
        ("m", "1e999 m", "not a finite number"),
        ("m", 1e300, "beyond any landing gear"),
        ("m", "1e-30 m", "beyond any landing gear"),
        ("m", "1e999999999 km", "not a finite number"),
        ("rad", "31 %", "another dimension"),
        ("1", "31 deg", "another dimension"),
        ("m", "5 m/0", "unknown"),
    ],
)
def test_everything_else_is_refused_with_what_is_allowed(unit, found, says):
    with pytest.raises(PydanticCustomError) as error:
        Quantity(unit, example="1 " + unit)(found)
    assert says in error.value.message()
    assert "allowed: a number" in error.value.message()


def test_limits_are_open_or_closed_as_declared():
    quantity = Quantity("m", above=0, at_most=2)
    assert quantity("2 m") == 2.0
    for outside in (0, "-1 mm", "2.001 m"):
        with pytest.raises(PydanticCustomError, match="out of range"):
            quantity(outside)


@settings(derandomize=True, deadline=None, max_examples=200)
@given(st.floats(1e-7, 1e4) | st.floats(-1e4, -1e-7) | st.just(0.0))
def test_plain_numbers_pass_unchanged(number):
    assert Quantity("m")(number) == number


@settings(derandomize=True, deadline=None, max_examples=100)
@given(st.decimals(min_value=-1000, max_value=1000, places=3))
def test_decimal_text_is_rounded_only_once(number):
    # 600 mm must be the float nearest to 0.6, not 600 * 0.001
    assert Quantity("m")(f"{number} mm") == float(number / 1000)
