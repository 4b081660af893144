"""The page of printed and derived coefficients is what the derivation writes."""

import pytest
import sympy as sp
from routh_page import LAYOUTS, PAGE, C, K, P, derived, page

from damperopt.literature.arreaza2015.printed import COEFFICIENTS, MISPRINTS


@pytest.fixture(scope="module")
def text():
    return page()


def test_page_is_up_to_date(text):
    assert PAGE.read_text(encoding="utf-8") == text, "run: python tests/literature/routh_page.py"


def test_page_marks_the_misprinted_equations_and_no_others(text):
    marked = [line.split("(")[1].split(")")[0] for line in text.splitlines() if line.endswith("misprinted")]
    assert marked == ["3-17", "3-18", "3-19", "3-34", "3-35", "3-37", "3-49", "3-50", "3-51", "3-52"]


@pytest.mark.parametrize("layout", LAYOUTS)
def test_printed_and_what_it_lost_make_the_derived_coefficients(layout):
    """In symbols, where the errata's tests take random rational numbers."""
    *_, k_psi, c_psi = LAYOUTS[layout]
    for i, (has, follows) in enumerate(zip(COEFFICIENTS[layout](P), derived(layout), strict=True)):
        lost = sum(terms.get(i, 0) for terms in MISPRINTS[layout](P).values())
        assert sp.simplify(has + lost - follows.subs({K: k_psi, C: c_psi})) == 0
