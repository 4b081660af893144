"""Units as engineers write them, and the pattern that editors check them by: both agree."""

import re

import pytest
from pydantic_core import PydanticCustomError

from damperopt.quantities.spelling import text_pattern
from damperopt.quantities.units import Quantity, number

POUND, INCH, FOOT, SLUG = 4.4482216152605, 0.0254, 0.3048, 14.593902937206

SPELLED = {
    "N m s/rad": {
        "300 Nms/rad": 300, "300 N·m·s/rad": 300, "2 kNms/rad": 2000, "5 N-m-s/rad": 5, "3 N m s rad^-1": 3, "5 N m s": 5,
        "100 in-lb-s/rad": 100 * INCH * POUND, "100 in-lbf-s/rad": 100 * INCH * POUND, "1 ft-lb-s/rad": FOOT * POUND,
    },
    "N m/rad": {"380 kNm/rad": 380e3, "1 in-lbf/rad": INCH * POUND, "5 N m": 5},
    "kg m^2": {
        "100 kgm2": 100, "100 kg.m^2": 100, "5 kg·m²": 5, "1 slug in^2": SLUG * INCH**2, "1 slug-ft^2": SLUG * FOOT**2,
        "1 lb-in-s^2": POUND * INCH, "1 lbf in s^2": POUND * INCH,
    },
    "N": {"150kN": 150e3, "1 lbf": POUND, "1 lb": POUND, "2 kips": 2000 * POUND, "1e5N": 1e5},
    "N m": {"12 kNm": 12e3, "12 kN-m": 12e3, "1 in-lb": INCH * POUND, "1 ft-lbf": FOOT * POUND, "12 Nmm": 0.012},
    "N/m": {"4 kN/mm": 4e6, "1 lbf/in": POUND / INCH, "1 lb/in": POUND / INCH},
    "N s/m": {"1e4 Ns/m": 1e4, "1 lbf-s/in": POUND / INCH},
    "m/s": {"120 kts": 120 * 1852 / 3600, "100 km/h": 100 / 3.6, "5 m/sec": 5},
    "m": {"1 in": INCH, "5in": 5 * INCH, "0.12 metre": 0.12},
    "m^4": {"3 in4": 3 * INCH**4, "1 mm⁴": 1e-12},
    "Pa": {"30 Msi": 30e6 * POUND / INCH**2, "200 N/mm2": 200e6},
    "rad": {"31°": 0.5410520681182421},
    "rad/s": {"60 rpm": 6.283185307179586, "1 rev/min": 0.10471975511965977},
    "1/s": {"0.1 1/s": 0.1, "0.1 s^-1": 0.1},
    "kg/m^3": {"7850 kg/m3": 7850, "0.28 lb/in3": 0.28 * SLUG * FOOT / 32.17404855643044 / FOOT / INCH**3 },
}  # fmt: skip

NONE_OF_IT = {
    "m": ["70 kg", "5 m deg", "10 % m", "5 m^2", "5 N", "5 m/s", "010 m", "0,1 m"],
    "N": ["5 kg", "5 N m", "150 KN", "1:30 N"],
    "N m s/rad": ["2 N m s rad", "2 N m", "70 kg"],
    "m/s": ["5 m", "5 m/s/s", "120 KTAS"],
    "rad/s": ["1 Hz", "1 1/s", "1 kHz"],
    "1/s": ["0.1 Hz", "1 rpm", "1 deg/s"],
    "1/rad": ["5 %", "5 rad"],
    "m^4": ["1 m^3", "1 m"],
    "Pa": ["5 N", "5 N/m"],
    "kg m^2": ["3 kg m", "3 kg"],
}


@pytest.mark.parametrize(("unit", "text", "value"), [(u, t, v) for u, texts in SPELLED.items() for t, v in texts.items()])
def test_common_spellings_are_read_and_pass_the_pattern(unit, text, value):
    assert Quantity(unit)(text) == pytest.approx(value, rel=1e-9)
    assert re.search(text_pattern(unit), text)


@pytest.mark.parametrize(("unit", "text"), [(u, t) for u, texts in NONE_OF_IT.items() for t in texts])
def test_other_dimensions_pass_neither(unit, text):
    with pytest.raises(PydanticCustomError):
        Quantity(unit)(text)
    assert not re.search(text_pattern(unit), text)


@pytest.mark.parametrize(
    ("unit", "text", "hint"),
    [
        ("N", "150 KN", "'kN'"),
        ("N m", "12 KNM", "'kN m'"),
        ("Pa", "200 mpa", "'MPa'"),
        ("m/s", "120 KIAS", "'kt'"),
        ("m/s", "100 kmh", "'km/h'"),
        ("rad", "31 DEG", "'deg'"),
        ("kg m^2", "5 KGM2", "'kg m^2'"),
    ],
)
def test_near_misses_come_with_what_was_perhaps_meant(unit, text, hint):
    with pytest.raises(PydanticCustomError) as error:
        Quantity(unit)(text)
    assert f"did you mean {hint}?" in error.value.message()


@pytest.mark.parametrize("text", ["12", "+1.5", "-.5e-3", "1e5", "0"])
def test_plain_numbers_of_the_command_line(text):
    assert number(text) == float(text)


@pytest.mark.parametrize("text", ["1_0", "010", "nan", "inf", "infinity", "١", "1e400", "1e-400", "0x1", "1" * 100, "", "1 m"])
def test_no_plain_numbers(text):
    assert number(text) is None


def test_the_pattern_gives_up_soon_on_a_long_text():
    assert not re.search(text_pattern("N m/rad"), "5 " + "m" * 2000 + "!")
