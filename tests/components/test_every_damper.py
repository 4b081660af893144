"""Every kind of damper, with the first layout that it goes with."""

import itertools

import chains
import numpy as np
import pytest
import standard
from scipy.integrate import solve_ivp
from standard import least, once
from whole import goes_through_the_commands, is_optimised, is_reported

from damperopt.dampers.base import Context
from damperopt.expressions.corners import Linear, Smooth
from damperopt.linkages.assembly import assemblies
from damperopt.linkages.elastic import elastic_linkage
from damperopt.strength.limit_event import limit_event
from damperopt.study.components import rooms

KINDS = rooms()["dampers"]


def home_of(kind):
    """Block of the layout that a damper goes with: the boeing layout, or the first other one."""
    layouts = [made.LAYOUT for made in assemblies().values() if made.KIND is kind]
    assert layouts, f"{kind.__name__} goes with no layout"
    usual = [layout for layout in layouts if layout is rooms()["linkages"]["boeing"]]
    return standard.example((usual or layouts)[0])


def damper_blocks():
    """Every damper in a rigid chain and in an elastic one; in full with its own compliance as a number."""
    for tag, kind in KINDS.items():
        home = home_of(kind) | {"kind": tag}
        found = standard.blocks(kind, lambda block, home=home: standard.takes(damper=home | block))
        chains = ("",) if kind.ROTARY else ("rigid", "sized")
        for (i, block), chain in itertools.product(enumerate(found), chains):
            compliance = {"compliance": chain} if chain else {}
            yield pytest.param(home | compliance | block, id=" ".join(filter(None, (tag, chain, "full" * i))))


BLOCKS = once(list(damper_blocks()))


@pytest.fixture(scope="module", params=BLOCKS)
def study(request):
    return standard.study_of(damper=request.param)


@pytest.fixture
def at_rest(study):
    return {state.name: 0.0 for state in study.damper.STATES}


POINTS = [(0.0, 0.0), (1e-3, 0.02), (-2e-3, 0.3), (1e-3, -0.5)]
"""Stroke [m] and rate [m/s], or angle and rate."""


def test_equations(study):
    standard.rest_is_an_equilibrium(study)
    standard.mirrored_motions_are_motions(study)
    standard.smooth_goes_to_exact(study)
    standard.declared_powers_are_kept_exactly(study)
    chains.states_of_the_chain(study)
    chains.energy_is_kept(study)
    standard.record_survives(study)


ACTUATOR = {"gains": {"yaw_angle": {"linear": 20.0}, "yaw_rate": {"constant": 500.0, "quadratic": -0.1}}}


@pytest.mark.parametrize("kind", ["hydraulic", "vane", "magnetorheological", "bouc_wen"])
def test_equations_with_control(kind):
    """An actuator with lag and limit, or a law that commands the current."""
    block = home_of(KINDS[kind]) | standard.example(KINDS[kind]) | {"kind": kind, "control": ACTUATOR}
    commanded = {"control_current": "1 A"} if KINDS[kind].COMMANDED else {}
    block["control"] = block["control"] | ({} if commanded else {"lag": "5 ms", "limit": "100 N m"})
    controlled = standard.study_of(damper=block | commanded)
    standard.rest_is_an_equilibrium(controlled)
    standard.mirrored_motions_are_motions(controlled)
    standard.smooth_goes_to_exact(controlled)
    standard.declared_powers_are_kept_exactly(controlled)
    standard.record_survives(controlled)


@pytest.mark.parametrize("corners", [Linear(), Smooth()], ids=["linear", "smooth"])
def test_damper_in_floats_is_its_graph(study, corners):
    damper, names = study.damper, [state.name for state in study.damper.STATES]
    variables = list(study.start)

    def everything(stroke, rate, *values):
        states = dict(zip(names, values, strict=False))
        design = dict(zip(variables, values[len(names) :], strict=True))
        made = damper.force(design, states, stroke, rate, Context(4e4, 30.0), corners)
        assert made.rates.keys() == set(names), "a rate for every state of its own"
        assert made.outputs.keys() <= {output.name for output in damper.KIND.OUTPUTS}, "outputs as they are declared"
        inverse = damper.rate(design, states, stroke, 1e3 * rate, Context(4e4, 30.0), corners)
        more = (damper.series(design), damper.damping(design), damper.peak_force(design, rate))
        return made.force, made.rates, made.outputs, [value for value in (inverse, *more) if value is not None]

    rest = [*(1e-3 for _ in names), *study.start.values()]
    standard.agrees_with_its_graph(everything, *([*point, *rest] for point in POINTS))


def test_inverse_gives_back_the_rate(study, at_rest):
    for stroke, rate in POINTS:
        for corners in (Linear(), standard.Narrow(1e-6)):
            force = study.damper.force(study.start, at_rest, stroke, rate, Context(4e4, 30.0), corners).force
            found = study.damper.rate(study.start, at_rest, stroke, force, Context(4e4, 30.0), corners)
            # a corner is rounded over the rate one way and over the force the other: the more alike, the narrower
            assert found is None or found == pytest.approx(rate, rel=1e-9, abs=1e-12)


def test_damping_is_the_slope_of_the_force(study, at_rest):
    damper, h = study.damper, 1e-6
    forces = [damper.force(study.start, at_rest, 0.0, v, Context(4e4, 30.0), Linear()).force for v in (-h, h)]
    slope, damping = (forces[1] - forces[0]) / (2 * h), damper.damping(study.start)
    assert slope >= 0, "a damper that drives"
    assert damping is None or damping == pytest.approx(slope, rel=1e-9)  # of a linear force
    assert sum(forces) == pytest.approx(0, abs=1e-9 * abs(forces[1])), "a force at rest"


@pytest.mark.parametrize(("amplitude", "frequency"), [(1e-3, 70.0), (5e-3, 40.0)])
def test_equivalent_has_the_first_harmonic(study, amplitude, frequency):
    """Against the force along a sinusoidal stroke, integrated until it repeats itself."""
    damper, context = study.damper, Context(4e4, 30.0)
    expected = damper.equivalent(study.start, amplitude, frequency, context)
    if expected is None:
        return
    names, corners = [state.name for state in damper.STATES], standard.Narrow(1e-9)

    def force(t, x):
        stroke, rate = amplitude * np.sin(frequency * t), amplitude * frequency * np.cos(frequency * t)
        return damper.force(study.start, dict(zip(names, x, strict=True)), stroke, rate, context, corners)

    period, x = 2 * np.pi / frequency, np.zeros(len(names))
    times = period * (np.arange(4000) + 0.5) / 4000
    if names:
        step = {"max_step": period / 200, "rtol": 1e-9, "atol": 1e-12}

        def rates(t, x):
            return list(force(t, x).rates.values())

        for _ in range(60):
            end = solve_ivp(rates, (0, period), x, **step).y[:, -1]
            if np.abs(end - x).max() <= 1e-9 * np.abs(end).max():
                break
            x = end
        motion = solve_ivp(rates, (0, period), x, t_eval=times, **step).y
    else:
        motion = np.zeros((0, times.size))
    forces = np.array([force(t, motion[:, i]).force for i, t in enumerate(times)])
    stiffness = 2 * np.mean(forces * np.sin(frequency * times)) / amplitude
    damping = 2 * np.mean(forces * np.cos(frequency * times)) / (amplitude * frequency)
    # a corner that is met between two of 4000 points of a cycle, and rounded ones
    size = np.hypot(stiffness, frequency * damping)
    assert expected[0] == pytest.approx(stiffness, abs=1e-3 * size)
    assert expected[1] * frequency == pytest.approx(damping * frequency, abs=1e-3 * size)


def test_parts_weigh(study):
    """Masses are positive and grow with the loads of the limit event; sizes start between their bounds."""
    if not study.variables:
        return
    damper, link = study.damper, elastic_linkage(study, study.start)
    event = limit_event(study, link, study.start, max(study.envelope.loads))
    sized = damper.parts(event, study.mass)
    if sized is None:
        return
    own = [size for size in sized.sizes if size.name not in study.start]
    for size in own:
        assert 0 < size.lower < size.start < size.upper
    for size in sized.sizes:
        assert size in own or size.symbol == study.start[size.name], "a design variable stands for itself"
        assert size.least
        for value, relaxed in size.least.values():
            assert float(value) > 0
            assert relaxed, "a limit that nothing relaxes"
    for mass in sized.masses.values():
        assert float(standard.with_sizes(mass, own)) > 0
        assert np.isfinite(float(standard.with_sizes(mass, own)))


def test_says_what_it_leaves_out(study):
    assert all(isinstance(words, str) and words for words in study.damper.leaves_out())


@pytest.mark.parametrize("study", once(BLOCKS), indirect=True)
def test_goes_through_the_commands(study, tmp_path):
    goes_through_the_commands(study, tmp_path)


@pytest.mark.parametrize("study", once(BLOCKS), indirect=True)
def test_is_optimised(study, tmp_path):
    is_optimised(study, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize("study", least(BLOCKS), indirect=True)
def test_is_reported(study, tmp_path):
    is_reported(study, tmp_path)
