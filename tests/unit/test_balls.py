"""Enclosures of the proof with contact memory: every one holds what it must, and is as small as its derivative says."""

from __future__ import annotations

from typing import ClassVar, Literal

import casadi as ca
import flint
import numpy as np
import pytest
from basic_twin import parameters
from memory_twin import F_Z, S, T, characteristic, gear, study_text

from damperopt import certify, linear_gear, loads
from damperopt.errors import CertificateError
from damperopt.expressions.calculus import atan, exp, sin, sqrt
from damperopt.proof.balls import SMALL, ball, enclosed, transit_of
from damperopt.proof.boxes import Strips
from damperopt.proof.quasi import Quasipolynomial
from damperopt.proof.rationals import decimal
from damperopt.stability.linear import LinearModel
from damperopt.study.envelope import Envelope
from damperopt.tyres.assembly import tyre
from damperopt.tyres.base import Linear as ForceLine
from damperopt.tyres.base import SlipLaw

Q = flint.fmpq


def exact(z):
    """E, phi1, chi and derivatives with 200 bits, from the closed forms."""
    with flint.ctx.workprec(300):
        E = (-z).exp()
        phi1 = (1 - E) / z
        chi = (1 + E) / z - 2 * (1 - E) / z**2
        return E, phi1, chi, (E - phi1) / z, (phi1 - E - 2 * chi) / z


@pytest.mark.parametrize("radius", [0.0, 1e-9, 1e-3, 0.2])
def test_transit_encloses_its_values(radius):
    rng = np.random.default_rng(4)
    for _ in range(200):
        centre = complex(*rng.standard_normal(2)) * 10 ** rng.uniform(-8, 1.3)
        if radius == 0 and abs(centre) == 0:
            continue
        z = flint.acb(flint.arb(centre.real, radius), flint.arb(centre.imag, radius))
        found = transit_of(z)
        inside = flint.acb(centre.real + radius * rng.uniform(-1, 1), centre.imag + radius * rng.uniform(-1, 1))
        values = (found.delayed, found.mean, found.chi, found.mean_z, found.chi_z)
        for enclosure, value in zip(values, exact(inside), strict=True):
            assert enclosure.overlaps(value)
            if radius == 0:
                assert float(abs(enclosure - value).abs_upper()) < 1e-11 * (1 + abs(complex(value.mid())))


def test_series_and_closed_form_meet():
    for angle in np.linspace(0, 6, 13):
        direction = complex(np.cos(angle), np.sin(angle))
        for size in (SMALL * 0.999, SMALL * 1.001):
            z = flint.acb(size * direction.real, size * direction.imag)
            found = transit_of(z)
            for enclosure, value in zip((found.mean, found.chi, found.mean_z, found.chi_z), exact(z)[1:], strict=True):
                assert enclosure.overlaps(value)
                assert float(enclosure.rad()) < 1e-11


def test_graphs_are_enclosed():
    """The data of a Magic-Formula-like law over a slice of loads; an operation without an enclosure is refused."""
    F, c = ca.SX.sym("F"), ca.SX.sym("c", 2)
    values = [c[0] * ca.sin(2 * ca.atan(F / c[1])), ca.sqrt(F) / (1 + F**2), ca.fabs(F - 3) + ca.exp(-F) * ca.log(F), F**3]
    values += [ca.if_else(F < 2, F, 2), ca.fmax(F, 2.5), ca.sign(F - 9)]
    function = ca.Function("data", [F, c], [ca.vertcat(*values)])
    numbers = [flint.arb(1.7), flint.arb(0.9)]
    over = enclosed(function, [[ball(flint.arb(1.5), flint.arb(4))], numbers])
    for x in np.linspace(1.5, 4, 41):
        for enclosure, value in zip(over, function(x, [1.7, 0.9]).full().ravel(), strict=True):
            assert enclosure.overlaps(flint.arb(float(value), 1e-12))
    with pytest.raises(CertificateError, match="no enclosure"):
        enclosed(ca.Function("data", [F, c], [ca.erf(F)]), [[flint.arb(1)], numbers])


ARCTANGENT = "law: arctangent, cornering_coefficient: 0.4, aligning_coefficient: 0.03, aligning_slip_limit: 0.17"


class Growing(SlipLaw):
    """Every number of the tyre grows with the load, none as a polynomial."""

    LOAD_POWERS: ClassVar = None

    law: Literal["growing"]

    def linear(self, load, pressure):
        share = load / 150e3
        force = 4.4e5 * sin(2 * atan(share))
        return ForceLine(force, 0.08 * force * sqrt(share), 0.3 * exp(0.2 * share), 0.1 * sqrt(share))

    def force(self, alpha_F, load, pressure):
        return self.linear(load, pressure).cornering_stiffness * alpha_F

    def moment(self, alpha_M, load, pressure, corners):
        return self.linear(load, pressure).aligning_stiffness * alpha_M


def growing(**keys):
    """A study whose whole tyre hangs on the load."""
    study = loads(study_text(gear(S, **keys)))
    shared = {"half_contact_length": 0.1, "relaxation_length": 0.3, "tread_width_moment": 570.0, "contact": "memory"}
    law = tyre(Growing).model_validate({"law": "growing", **shared})
    return type(study).model_construct(**{key: getattr(study, key) for key in type(study).model_fields} | {"tyre": law})


@pytest.fixture(scope="module", params=["stiffness", "arctangent", "rake", "third order", "growing"])
def strips(request):
    if request.param == "growing":
        study = growing()
        return Strips(Quasipolynomial(study, LinearModel(study).structure, {}), 0.3)
    p = gear(S, phi=0.15 if request.param == "rake" else 0.0)
    text = study_text(p, order=3 if request.param == "third order" else 5)
    if request.param == "arctangent":
        start, end = text.index("law:"), text.index(", half_contact")
        text = text[:start] + ARCTANGENT + text[end:]
        cut, stop = text.index(", cornering_stiffness"), text.index(", tread_width")
        text = text[:cut] + text[stop:]
    study = loads(text)
    return Strips(Quasipolynomial(study, LinearModel(study).structure, {}), 0.3)


def value(strips, w, V, F):
    return strips((V, V), (F, F)).at(w)


def test_boxes_hold_the_values_of_their_points(strips):
    rng = np.random.default_rng(8)
    for _ in range(60):
        ends = []
        for low, high in ((0.0, 200.0), (3.0, 80.0), (5e4, 2e5)):
            a = rng.uniform(low, high)
            ends.append((decimal(a), decimal(a * (1 + 10 ** rng.uniform(-6, -1)) + 1e-3)))
        w, V, F = ends
        strip = strips(V, F)
        direct, moves = strip.spread(w)
        middle, found = strip.at((w[0] + w[1]) / 2), moves()
        for _ in range(3):
            t = [Q(int(rng.integers(-1000, 1001)), 1000) for _ in range(3)]
            place = [(a + b) / 2 + x * (b - a) / 2 for (a, b), x in zip(ends, t, strict=True)]
            there = value(strips, *place)
            assert direct.overlaps(there)
            near = middle + sum((move * flint.arb(0, 1) for move in found.values()), flint.acb(0))
            assert near.overlaps(there)


def test_moves_are_the_derivatives(strips):
    """On small boxes each move is the difference that its direction makes: nothing is missing, and nothing too much."""
    w, V, F = Q(63), Q(17), Q(120_000)
    h = {"w": Q(1, 10**4), "V": Q(1, 10**5), "F": Q(1, 10)}
    strip = strips((V - h["V"], V + h["V"]), (F - h["F"], F + h["F"]))
    _, moves = strip.spread((w - h["w"], w + h["w"]))
    for name, move in moves().items():
        ends = []
        for side in (1, -1):
            place = {"w": w, "V": V, "F": F} | {name: {"w": w, "V": V, "F": F}[name] + side * h[name]}
            ends.append(value(strips, place["w"], place["V"], place["F"]))
        difference = complex((ends[0] - ends[1]).mid()) / 2
        assert complex(move.mid()) == pytest.approx(difference, rel=1e-4)


def test_polynomial_is_the_characteristic_function_of_the_twin():
    p = gear(T, phi=0.1)
    study = loads(study_text(p))
    strips = Strips(Quasipolynomial(study, LinearModel(study).structure, {}), 0.25)
    scale = p.sigma * p.I_z * p.I_x
    for w, V in ((0.5, 2.0), (30.0, 9.0), (101.0, 40.0), (500.0, 100.0)):
        ours = complex(value(strips, decimal(w), decimal(V), decimal(F_Z)).mid())
        theirs = characteristic(-0.25 + 1j * w, V, F_Z, p)
        assert ours == pytest.approx(theirs * V / scale, rel=1e-9)


def test_far_field():
    """Beyond R the twin has no root right of the line, and D is its leading term but for less than itself."""
    study = loads(study_text(gear(T)))
    strips = Strips(Quasipolynomial(study, LinearModel(study).structure, {}), 2.0)
    strip = strips((Q(5), Q(10)), (Q(150_000), Q(150_000)))
    R = float(strip.radius())
    p = parameters(**T)
    scale = p.sigma * p.I_z * p.I_x
    for V in (5.0, 7.0, 10.0):
        for s in R * np.exp(1j * np.linspace(-1.57, 1.57, 9)):
            s = complex(max(s.real, -2.0), s.imag)
            assert abs(characteristic(s, V, F_Z, p) * V / scale / s**5 - 1) < 1


@pytest.mark.parametrize("c_psi", [350.0, 600.0, 2000.0])
def test_range_of_loads_that_move_the_whole_tyre(c_psi):
    """Proved or refuted as eigenvalues of a grid say; the tyre is another one at every load."""
    study = growing(c_psi=c_psi)
    ranged = study.model_copy(update={"envelope": study.envelope.model_copy(update={"vertical_load": LOADS})})
    V, F = (x.ravel() for x in np.meshgrid(np.geomspace(5, 100, 80), np.linspace(8e4, 1.6e5, 15)))
    worst = linear_gear(study, {}).abscissa(V, F).max()
    certificate = certify(ranged, {}, 0.0)
    assert certificate.method == "balls, rectangle"
    assert certificate.verdict == ("proved" if worst < 0 else "refuted"), (worst, certificate.reason)


LOADS = Envelope.model_validate({"speed": {"min": 5, "max": 100}, "vertical_load": {"min": 8e4, "max": 1.6e5}}).vertical_load
