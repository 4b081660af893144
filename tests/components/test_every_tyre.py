"""Every slip law with the usual contact line, and every contact line with a linear and a usual law."""

import math
from inspect import signature

import numpy as np
import pytest
import standard
from standard import least
from whole import goes_through_the_commands, is_optimised, is_reported

from damperopt.expressions.corners import Smooth
from damperopt.ports.wheel import Wheel
from damperopt.study.components import rooms
from damperopt.tyres.base import Linear

LAWS, LINES = rooms()["slip laws"], rooms()["contact lines"]


def tyre_blocks():
    for tag, law in LAWS.items():
        shared = {key: value for key, value in standard.TYRE.items() if key not in law.GIVES}
        taken = standard.blocks(law, lambda block, shared=shared: standard.takes(tyre=shared | block))
        for i, block in enumerate(taken):
            yield pytest.param(shared | block, id=f"{tag}{' full' * i}")
    for tag, line in LINES.items():
        for i, block in enumerate(standard.blocks(line, lambda block: True)):
            law = next(iter(LAWS.values()))
            keys = standard.TYRE | standard.example(law) | {"contact": block}
            if not line.RELAXES:
                del keys["relaxation_length"]
            yield pytest.param(keys, id=f"contact {tag}{' full' * i}")


BLOCKS = list(tyre_blocks())


@pytest.fixture(scope="module", params=BLOCKS)
def study(request):
    return standard.study_of(tyre=request.param)


def test_equations(study):
    standard.rest_is_an_equilibrium(study)
    standard.mirrored_motions_are_motions(study)
    standard.smooth_goes_to_exact(study)
    standard.declared_powers_are_kept_exactly(study)
    standard.record_survives(study)


def test_peaks_bound_force_and_moment(study):
    for load in (10e3, 40e3, 150e3):
        standard.peaks_bound(study.tyre, load)


def test_law_in_floats_is_its_graph(study):
    law, points = study.tyre, [(alpha, load) for alpha in (-0.5, -0.1, 0.0, 1e-3, 0.15, 0.6) for load in (1e4, 15e4)]

    def everything(alpha, load):
        linear = Linear(*law.linear(load, law.pressure))
        peaks = law.peaks(load, law.pressure)
        return (
            law.force(alpha, load, law.pressure),
            law.moment(alpha, load, law.pressure, Smooth()) * 1.0,
            tuple(linear),
            None if peaks is None else (peaks.side_force, peaks.aligning_moment),
        )

    standard.agrees_with_its_graph(everything, *points)


def test_law_starts_with_its_small_slip_data(study):
    """Slopes of force and moment at zero slip are C_Fa and C_Ma."""
    law, h = study.tyre, 1e-6
    C_Fa, C_Ma, _, _ = Linear(*law.linear(4e4, law.pressure))
    force = (law.force(h, 4e4, law.pressure) - law.force(-h, 4e4, law.pressure)) / (2 * h)
    moment = (law.moment(h, 4e4, law.pressure, Smooth()) - law.moment(-h, 4e4, law.pressure, Smooth())) / (2 * h)
    # a slope by differences at 1e-6 rad: |slip| in the laws leaves terms of the first order in it
    assert force == pytest.approx(C_Fa, rel=1e-5)
    assert moment == pytest.approx(C_Ma, rel=1e-4)


def test_line_in_floats_is_its_graph(study):
    tyre = study.tyre
    linear, count = Linear(*tyre.linear(4e4, tyre.pressure)), len(tyre.states)

    def slips(theta, theta_t, eta, eta_t, V, *x):
        return tuple(tyre.contact.slips(Wheel(V, theta, theta_t, eta, eta_t, 0.1, 4e4), linear, x))

    points = np.random.default_rng(1).uniform(-0.02, 0.02, (4, 5 + count))
    points[:, 4] = (5.0, 20.0, 60.0, 100.0)
    standard.agrees_with_its_graph(slips, *points)


def test_line_at_rest_and_at_small_slip_is_its_response(study):
    """Its linear equations, run at a path frequency, give the transfer functions that it states."""
    line, linear, V, s = study.tyre.contact, Linear(4e5, 3e4, 0.3, 0.1), 30.0, 2.5j
    if not line.RATIONAL:
        return
    h, n = 1e-6, len(line.states())

    def column(index):
        """Derivatives of rates and slips with respect to one of theta, theta', eta, eta', states."""
        found = []
        for sign in (1, -1):
            u = np.zeros(4 + n)
            u[index] = sign * h
            rates, force, moment = line.slips(Wheel(V, *u[:4], 0.1, 4e4), linear, tuple(u[4:]))
            found.append(np.array([*rates, force, moment], float))
        return (found[0] - found[1]) / (2 * h)

    J = np.column_stack([column(i) for i in range(4 + n)])
    expected = line.response(s, linear, **({"speed": V} if "speed" in signature(line.response).parameters else {}))
    for k, motion in enumerate((np.array([1, V * s, 0, 0]), np.array([0, 0, 1, V * s]))):
        driven = J[:, :4] @ motion
        x = np.linalg.solve(V * s * np.eye(n) - J[:n, 4:], driven[:n]) if n else np.zeros(0)
        alpha_F, alpha_M = driven[n:] + J[n:, 4:] @ x
        assert 4e5 * alpha_F == pytest.approx(expected[k], rel=1e-7)
        assert 3e4 * alpha_M == pytest.approx(expected[2 + k], rel=1e-7)
    assert math.isfinite(abs(expected[0]))


def test_goes_through_the_commands(study, tmp_path):
    goes_through_the_commands(study, tmp_path)


def test_is_optimised(study, tmp_path):
    is_optimised(study, tmp_path)


@pytest.mark.verify
@pytest.mark.parametrize("study", least(BLOCKS), indirect=True)
def test_is_reported(study, tmp_path):
    is_reported(study, tmp_path)
