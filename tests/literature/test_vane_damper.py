"""Rotary vane damper: its oil as a Maxwell element, its parts by hand, and the least damping that it is optimised to."""

from __future__ import annotations

import math

import numpy as np
import pytest
from components_of import damper_of
from scipy.integrate import solve_ivp
from table_gear import TYRE, table_gear

from damperopt import Study, certify, optimise, simulate_exactly
from damperopt.ports.sizing import LimitEvent
from damperopt.stability.linear import linear_gear
from damperopt.study.mass_model import MassModel

VANE = {"topology": "rotational", "kind": "vane", "torsional_stiffness": 3.8e5, "mean_radius": 0.08, "vane_width": 0.05}
D, BETA, SWEEP = 2e-4, 1.2e9, math.radians(50)


def gear(start=1000.0, bounds=(10.0, 1e6), **damper):
    base = table_gear(wheel_radius=0.362, kind="yaw").model_dump(exclude_none=True)
    base["gear"].pop("lateral")
    required = {
        "stability_margin": 0.1,
        "limit_torque": 1e4,
        "lug_distance": {"min": 0.4, "max": 1.2},
        "reach": {"min": 0.1, "max": 0.4},
    }
    more = {
        "damper": VANE | damper,
        "requirements": required,
        "design": {"c_vane": {"start": start, "min": bounds[0], "max": bounds[1]}},
    }
    envelope = {"speed": {"min": 5.0, "max": 100.0}, "vertical_load": 150e3}
    return Study.model_validate(base | more | {"envelope": envelope})


def test_oil_is_a_spring_in_series():
    """At an eigenvalue s the gear with the dynamic stiffness s c k/(k + s c) in the damper's place has it too."""
    k = 2 * BETA * D / SWEEP
    study = gear(displacement=D)
    assert study.damper.series(study.start) == pytest.approx(k)
    values = np.linalg.eigvals(linear_gear(study).matrices(40.0, 150e3)[0])
    free, stiffer = (linear_gear(table_gear(s, 0.0, kind="yaw")).matrices(40.0, 150e3)[0] for s in (3.8e5, 4.8e5))
    for s in values:
        made = free + (stiffer - free) * (s * 1000.0 * k / (k + s * 1000.0)) / 1e5
        assert np.abs(np.linalg.eigvals(made) - s).min() < 1e-6 * abs(s)
    assert linear_gear(study).states[-1].name == "dashpot_angle"
    assert linear_gear(study).states[-1].unit == "rad"


def test_damping_that_the_oil_lets_through_is_k_over_2_omega():
    """The largest real part of s c k/(k + s c)/s over c is at c = k/omega."""
    k, omega = 2 * BETA * D / SWEEP, 70.0
    found = [(1j * omega * c * k / (k + 1j * omega * c)).imag / omega for c in (0.9 * k / omega, k / omega, 1.1 * k / omega)]
    assert max(found) == found[1] == pytest.approx(k / (2 * omega))


def test_least_damping_of_the_third_order_is_found_and_proved():
    """The critical damping of the gear at 0.1 1/s margin is what eigenvalues over a fine grid of speeds say, to rounding."""
    result = optimise(gear())
    assert result.status == "solved"
    assert result.certificate.proved
    speeds = np.linspace(5.0, 100.0, 4000)

    def worst(c):
        return linear_gear(table_gear(3.8e5, c, kind="yaw")).abscissa(speeds, 150e3).max()

    low, high = 500.0, 2000.0
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (low, middle) if worst(middle) <= -0.1 else (middle, high)
    assert result.design["c_vane"] == pytest.approx(high, rel=1e-4)
    assert set(result.mass.parts) == {"damper"}
    assert not certify(gear(), {"c_vane": 0.99 * high}, margin=0.1).proved


def test_parts_by_hand():
    """A torque of 8 kN m at 20.7 MPa on two vanes of 50 mm at 80 mm."""
    damper, model, T = damper_of(**VANE), MassModel(), 8e3
    event = LimitEvent(1e4, 0.03, 2.0, 0.03, T, 0, 0, 1e4, 100.0, 1.5)
    sized = damper.parts(event, model)
    (size,) = sized.sizes
    assert float(size.least["vane_pressure"][0]) == pytest.approx(T / (20.7e6 * 2 * 0.05 * 0.08))
    import casadi as ca

    sigma, p, h = model.damper_material.yield_strength / 1.5, 20.7e6, 0.05
    wall, cap = 0.002 + p * 0.105 / sigma, 0.002 + 0.105 * math.sqrt(0.75 * p / sigma)
    rotor = 0.002 + math.sqrt(3) * T / (2 * math.pi * 0.055**2 * sigma)
    metal = 2 * math.pi * (0.105 + wall / 2) * wall * h + 2 * math.pi * (0.105 + wall) ** 2 * cap
    metal += 2 * math.pi * 0.055 * rotor * (h + 2 * cap) + 4 * 0.05 * (0.002 + 0.05 * math.sqrt(3 * p / sigma)) * h
    expected = 1.5 * model.damper_material.density * metal + 860 * 2 * math.pi * 0.08 * 0.05 * h
    found = float(ca.substitute(sized.masses["damper"], size.symbol, h))
    assert found == pytest.approx(expected)
    larger = damper_of(**VANE, displacement=D).parts(event, model).sizes[0]
    assert float(larger.least["vane_displacement"][0]) == pytest.approx(D / (2 * 0.05 * 0.08))


def test_orifice_and_oil_against_an_equation_of_the_pressure():
    """k (psi - phi) = c phi' + c_2 phi' |phi'|, solved here for phi' by bisection, in a gear without tyre."""
    none = {**TYRE, "cornering_slope": 0.0, "aligning_coefficient": 0.0, "tread_width_moment": 0.0}
    c, c_2, k = 200.0, 5e3, 2 * BETA * 1e-5 / SWEEP
    study = gear(c, displacement=1e-5, orifice={"coefficient": c_2}).replace(tyre=none, gear__caster_length=0.0)
    motion = simulate_exactly(study, speed=30.0, disturbance={"release": {"yaw_angle": 0.1}}, duration=0.3, points=61)

    def rate(torque):
        low, high = 0.0, abs(torque) / c + 1e-12
        for _ in range(80):
            middle = (low + high) / 2
            low, high = (middle, high) if c * middle + c_2 * middle**2 < abs(torque) else (low, middle)
        return math.copysign(low, torque)

    def equations(t, x):
        torque = k * (x[0] - x[2])
        return [x[1], (-3.8e5 * x[0] - torque) / 100.0, rate(torque)]

    twin = solve_ivp(equations, (0, 0.3), [0.1, 0.0, 0.1], rtol=1e-9, atol=1e-11, t_eval=motion.time)
    np.testing.assert_allclose(motion["yaw_angle"], twin.y[0], rtol=0, atol=1e-6)


@pytest.mark.parametrize(("keys", "message"), [({"vane_width": 0.2}, "less than twice that"), ({"vanes": 4.0}, "a full turn")])
def test_vanes_that_do_not_fit(keys, message):
    with pytest.raises(ValueError, match=message):
        damper_of(**(VANE | keys))
