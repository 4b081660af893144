"""Loops against gears by hand: counts against eigenvalues and roots, margins against scaled gears and a reference table."""

from __future__ import annotations

import numpy as np
import pytest
from basic_twin import state_matrix
from memory_twin import F_Z, O, T, gear, rightmost, study_text

from damperopt import ConfigError, loads
from damperopt.errors import DamperoptError
from damperopt.stability.loop import Loop, opened
from damperopt.stability.margins_of_loop import locus_of, margins_of, margins_over_speed

LINES = "leading_point", "memory"


@pytest.fixture(scope="module")
def loops():
    """Of O by contact line and break."""
    studies = {line: loads(study_text(gear(O), contact=line)) for line in LINES}
    return {(line, where): opened(study, {}, where) for line, study in studies.items() for where in ("tyre", "damper")}


def abscissa(line, V, tyre=1.0, damping=1.0):
    """Of O by hand with the whole tyre, the tread width apart, and the damping times a factor."""
    p = gear(O, C_F=tyre * O["C_F"], C_M=tyre * O["C_M"], c_psi=damping * O["c_psi"])
    if line == "memory":
        return rightmost(V, F_Z, p, count=1)[0].real
    return np.linalg.eigvals(state_matrix(V, F_Z, p)).real.max()


@pytest.mark.parametrize("line", LINES)
@pytest.mark.parametrize("where", ["tyre", "damper"])
def test_turns_count_the_unstable_eigenvalues(line, where):
    """Table 0.1 is stable and unstable in turn over speed; numbers of eigenvalues are those of matrices written by hand."""
    at, seen = opened(loads(study_text(gear(T, c_psi=300.0), contact=line)), {}, where), set()
    for V in (3.0, 9.0, 20.0, 110.0, 150.0):
        p = gear(T, c_psi=300.0)
        roots = rightmost(V, F_Z, p) if line == "memory" else np.linalg.eigvals(state_matrix(V, F_Z, p))
        locus, unstable = locus_of(at(V, F_Z)), int((roots.real > 0).sum())
        phase = np.unwrap(np.angle(locus.difference))
        assert locus.open_unstable - round((phase[-1] - phase[0]) / np.pi) == locus.implied == unstable
        seen.add(unstable)
    assert seen == {0, 2}


@pytest.mark.parametrize(
    ("line", "where", "alphas"),
    [
        ("leading_point", "tyre", (0.3057, 0.4608, 0.9083, 0.9627, 0.9878)),
        ("leading_point", "damper", (0.8147, 1.0173, 1.2264, 1.1167, 1.3791)),
        ("memory", "damper", (1.8802, 0.5725, 1.1829, 1.3634, 1.4091)),
    ],
)
def test_disk_margins_of_the_reference_table(loops, line, where, alphas):
    """Worked out beforehand from the characteristic functions of both gears; on the leading point the string is the tyre."""
    found = [margins_of(loops[line, where](V, F_Z)).disk for V in (5.0, 8.75, 20.0, 40.0, 100.0)]
    assert found == pytest.approx(alphas, abs=6e-5)


@pytest.mark.parametrize("line", LINES)
def test_gain_margins_are_where_a_scaled_gear_turns_unstable(loops, line):
    tyre = margins_of(loops[line, "tyre"](8.75, F_Z))
    assert tyre.gain_down == 0
    for part, sign in ((0.999, -1), (1.001, 1)):
        assert sign * abscissa(line, 8.75, tyre=part * tyre.gain_up) > 0
    assert all(abscissa(line, 8.75, tyre=f) < 0 for f in np.linspace(0.05, 0.99 * tyre.gain_up, 30))
    damper = margins_of(loops[line, "damper"](40.0, F_Z))
    assert damper.gain_up == np.inf
    for part, sign in ((0.999, 1), (1.001, -1)):
        assert sign * abscissa(line, 40.0, damping=part * damper.gain_down) > 0
    if line == "memory":
        assert tyre.gain_up == pytest.approx(1.43, abs=5e-3)  # the root locus of the whole tyre


def test_phase_and_disk_reach_the_limit_and_nothing_nearer_does(loops):
    """det(1 + f L) = 0 at the turned and the worst complex factor; a cloud of factors within the disk leaves it away from 0."""
    loop = loops["memory", "tyre"](8.75, F_Z)
    m = margins_of(loop)

    def least(w, f):
        """Least abs(det(1 + f L)) over frequencies (k,) and factors (m,)."""
        L = loop.response(1j * np.atleast_1d(w))
        trace, det = (part[:, None] for part in (np.trace(L, axis1=1, axis2=2), np.linalg.det(L)))
        return np.abs(1 + f * trace + f**2 * det).min()

    def disk(radius, count):
        delta = radius * np.exp(1j * np.linspace(0, 2 * np.pi, count))
        return (1 + delta) / (1 - delta)

    assert least(m.phase_at, np.exp(1j * m.phase * np.array([1, -1]))) < 1e-8
    assert least(m.disk_at, disk(m.disk / 2, 20001)) < 1e-3
    assert least(np.linspace(90, 110, 4001), disk(0.95 * m.disk / 2, 61)) > 1e-3


def test_over_speed_the_weakest_is_found_between_the_given_ones(loops):
    over = margins_over_speed(loops["memory", "tyre"], np.array([5.0, 8.0, 11.0, 20.0]), F_Z)
    weak = over.speeds[over.weakest]
    assert weak == pytest.approx(9.1, abs=0.1)
    near = [margins_of(loops["memory", "tyre"](V, F_Z)).disk for V in (weak - 0.05, weak + 0.05)]
    assert over.margins[over.weakest].disk < min(near)


def test_open_pole_on_the_axis_is_passed_on_the_right():
    """L = k/(s (s + 1)^2): closed poles are roots of s (s + 1)^2 + k, unstable beyond k = 2."""
    for k, unstable in ((1.0, 0), (4.0, 2)):
        closed = np.roots([1, 2, 1, k])
        loop = Loop(1.0, 1.0, lambda s, k=k: (k / (s * (s + 1) ** 2))[:, None, None], np.array([0, -1, -1.0]), closed)
        assert locus_of(loop).implied == (closed.real > 0).sum() == unstable
        if not unstable:
            assert margins_of(loop).gain_up == pytest.approx(2.0, rel=1e-4)


def test_count_that_disagrees_gives_no_margin():
    loop = Loop(1.0, 1.0, lambda s: (4 / (s + 1) ** 3)[:, None, None], -np.ones(3), np.array([1 + 1j, 1 - 1j, -5]))
    with pytest.raises(DamperoptError, match="no margin is given"):
        margins_of(loop)


def test_what_cannot_be_opened_is_refused(loops):
    with pytest.raises(ConfigError, match="allowed: speeds from about"):
        locus_of(loops["memory", "tyre"](0.001, F_Z))
    study = loads(study_text(gear(O), contact="leading_point"))
    undamped = study.replace(damper__torsional_damping=0.0)
    with pytest.raises(ConfigError, match=r"--break: found 'damper', but damper.kind 'torsional'"):
        opened(undamped, {}, "damper")
