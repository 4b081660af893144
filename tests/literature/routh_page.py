"""Writes docs/routh.md: the characteristic coefficients of chapter 3, printed and derived, with their differences.

    python tests/literature/routh_page.py

The printed ones are the package's transcription; the derived ones are worked out here from the thesis' matrix (3-5).
"""

from pathlib import Path
from types import SimpleNamespace

import sympy as sp

from damperopt.literature.arreaza2015.printed import COEFFICIENTS

PAGE = Path(__file__).parents[2] / "docs" / "routh.md"

NAMES = {
    "I_x": "I_x", "I_z": "I_z", "V": "V", "sigma": r"\sigma", "kappa": r"\kappa", "C_F": r"C_{F\alpha}", "C_M": r"C_{M\alpha}",
    "F_z": "F_z", "l_g": "l_g", "e": "e", "a": "a", "k_y": "k_y", "c_y": "c_y",
    "c_lambda": r"c_\lambda", "k_lambda": r"k_\lambda",
    "E": "E", "I_arm": "I_{arm}", "L": "L", "sin_gamma": "s_\\gamma", "sin_alpha": "s_\\alpha", "R": "R", "b": "b",
}  # fmt: skip
P = SimpleNamespace(**{name: sp.Symbol(text, positive=True) for name, text in NAMES.items()})
K, C = sp.symbols(r"k_\psi c_\psi")
ELL = P.L * P.sin_gamma

LAYOUTS = {
    "boeing": ("Boeing", ["3-15", "3-16", "3-17", "3-18", "3-19", "3-20"], P.k_lambda * ELL**2, P.c_lambda * ELL**2),
    "utas": (
        "UTAS",
        ["3-32", "3-33", "3-34", "3-35", "3-36", "3-37"],
        2 * P.E * P.I_arm * ELL * P.sin_alpha / P.R**2,
        P.c_lambda * ELL**2 * P.b / (10 * P.R),
    ),
    "arreaza": ("New design", ["3-47", "3-48", "3-49", "3-50", "3-51", "3-52"], 2 * P.E * P.I_arm / ELL, P.c_lambda * ELL**2),
}
"""Title, equations, and the yaw stiffness and damping (3-11), (3-12); (3-26), (3-30); (3-42), (3-45)."""

HEAD = """# Characteristic coefficients of chapter 3

C. Arreaza's thesis prints the coefficients a_0 to a_5 of the characteristic equation for each layout. Below they stand
beside those that follow from its own matrix (3-5), with the yaw stiffness and damping that it derives for the layout, and
what the printed ones lack. This page is written by `tests/literature/routh_page.py`, and a test holds it to what that
writes: nothing here is typed.

Where the thesis writes c_delta, k_delta for the damper's damping and stiffness, c_lambda, k_lambda are read; s_gamma and
s_alpha are sin(gamma) and sin(alpha). Boeing and UTAS leave out the lateral damping c_y, and so do their derived
coefficients here. All carry the thesis' sign of kappa (erratum 1).

What each misprint does to a figure is on the page that `damperopt thesis` writes. In short: with the printed coefficients
Boeing's and UTAS' gears are unstable nearly everywhere, so its figures were not drawn with what is printed.
"""


def derived(layout):
    """[a_0, ..., a_5] of det(l I - A) with k_psi and c_psi as symbols, scaled as the thesis scales them."""
    c_y = P.c_y if layout == "arreaza" else 0
    A = sp.Matrix(
        [
            [0, 1, 0, 0, 0],
            [-K / P.I_z, -C / P.I_z + P.kappa / (P.V * P.I_z), 0, 0, P.F_z * (P.C_M - P.e * P.C_F) / (P.I_z * P.sigma)],
            [0, 0, 0, 1, 0],
            [P.F_z * P.e / P.I_x, 0, -P.k_y / P.I_x, -c_y / P.I_x, -P.l_g * P.F_z * P.C_F / (P.I_x * P.sigma)],
            [P.V, P.e - P.a, 0, P.l_g, -P.V / P.sigma],
        ]
    )
    scale = 1 if layout == "boeing" else P.I_x * P.I_z * P.V * P.sigma
    root = sp.Symbol("l")
    polynomial = sp.Poly((root * sp.eye(5) - A).det(method="berkowitz"), root)
    return [sp.expand(scale * a) for a in polynomial.all_coeffs()]


def short(expression):
    """Over one denominator, collected by stiffness, damping and tread moment."""
    top, bottom = sp.fraction(sp.together(expression))
    return sp.collect(sp.expand(top), [K, C, P.kappa, P.k_y, P.F_z], sp.factor) / bottom


def page():
    """Text of the page."""
    text = [HEAD]
    for layout, (title, equations, k_psi, c_psi) in LAYOUTS.items():
        text.append(f"\n## {title}\n")
        text.append(f"$$k_\\psi = {sp.latex(k_psi)}, \\qquad c_\\psi = {sp.latex(c_psi)}$$\n")
        printed = COEFFICIENTS[layout](P)
        for i, (equation, has, follows) in enumerate(zip(equations, printed, derived(layout), strict=True)):
            lacks = sp.factor(sp.simplify(follows.subs({K: k_psi, C: c_psi}) - has))
            text.append(f"\n### a_{i}, ({equation}): {'as derived' if lacks == 0 else 'misprinted'}\n")
            text.append(f"Printed:\n\n$$a_{i} = {sp.latex(has)}$$\n")
            text.append(f"Derived:\n\n$$a_{i} = {sp.latex(short(follows))}$$\n")
            if lacks != 0:
                text.append(f"Derived less printed:\n\n$${sp.latex(lacks)}$$\n")
    return "\n".join(text).replace("\n\n\n", "\n\n")


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
