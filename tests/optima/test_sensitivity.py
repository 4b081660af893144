"""Shadow prices and sensitivities against solving again."""

import pytest

import damperopt

pytestmark = pytest.mark.slow

STEP = 2e-3
AGREES = 0.02  # second-order terms of the central difference and the reserve of the margin


def solve_near(study, result, **changes):
    starts = {f"design__{name}__start": value for name, value in result.design.items()}
    solved = damperopt.optimise(study.replace(**starts, **changes, solver__starts=1))
    assert solved.status == "solved"
    return solved.mass.total


@pytest.mark.parametrize(
    ("topology", "least", "enough"),
    [
        ("boeing", 0.1, 10),
        *(pytest.param(topology, 3e-4, 15, marks=pytest.mark.verify) for topology in ("boeing", "utas", "arreaza")),
    ],
)
def test_sensitivities_are_those_of_solving_again(topology, least, enough, main_gear, optimum):
    """Of all inputs, or of the strong ones."""
    study, result = main_gear.replace(damper__topology=topology), optimum(topology)
    checked = 0
    for s in result.sensitivities:
        if abs(s.elasticity) < least or s.value == 0 or s.input == "material.fatigue_exponent":
            continue
        key = s.input.replace(".", "__")
        up, down = (solve_near(study, result, **{key: s.value * (1 + sign * STEP)}) for sign in (1, -1))
        slope = (up - down) / (2 * STEP * s.value)
        assert s.derivative == pytest.approx(slope, rel=AGREES, abs=2e-5 * result.mass.total / abs(s.value)), s.input
        checked += 1
    assert checked >= enough


def test_inputs_without_effect_are_left_out(optimum):
    inputs = {s.input for s in optimum("boeing").sensitivities}
    assert "mass.arm_section.thickness_ratio" not in inputs
    assert "material.ultimate_strength" not in inputs


def test_end_of_the_speed_range_has_a_price_when_it_is_active(main_gear, optimum):
    """UTAS is limited at 5 m/s by the lateral mode: a higher minimum speed makes it lighter."""
    price = next(s for s in optimum("utas").sensitivities if s.input == "envelope.speed.min")
    assert price.derivative < 0
    faster = main_gear.replace(damper__topology="utas", envelope__speed__min=5.01)
    change = solve_near(faster, optimum("utas")) - optimum("utas").mass.total
    assert change == pytest.approx(price.derivative * 0.01, rel=AGREES)


@pytest.mark.parametrize("topology", ["boeing", "arreaza"])
def test_shadow_prices_are_those_of_moved_limits(topology, main_gear, optimum):
    study, result = main_gear.replace(damper__topology=topology), optimum(topology)
    price = next(c for c in result.constraints if c.name == "tyre_clearance").shadow_price
    up, down = (solve_near(study, result, requirements__tyre_clearance=0.05 + step) for step in (1e-4, -1e-4))
    assert price == pytest.approx((up - down) / 2e-4, rel=AGREES)
    margin = next(c for c in result.constraints if c.name == "stability_margin").shadow_price  # limit is -margin
    up, down = (solve_near(study, result, requirements__stability_margin=0.1 + step) for step in (5e-3, -5e-3))
    assert -margin == pytest.approx((up - down) / 1e-2, rel=AGREES)


def test_inactive_constraints_have_no_price(optimum):
    for topology in ("boeing", "utas", "arreaza"):
        for constraint in optimum(topology).constraints:
            if not constraint.active:
                assert constraint.multiplier < 1e-5
