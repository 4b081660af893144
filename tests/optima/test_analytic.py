"""Third order, Boeing, only the damping free: the optimum in closed form (theory page, third-order stability)."""

import numpy as np
import pytest
from scipy.optimize import minimize_scalar

import damperopt

RESERVE = 1e-9  # 1/s: the package solves for this margin where the closed form has none


def closed_form_damping(study, k_psi, V, F_z):
    """Smallest stabilising c_psi of the third-order gear at one speed: the root of its quadratic, less kappa/V."""
    gear, tyre = study.gear, study.tyre
    I_z, e, a, s, kappa = (
        gear.yaw_inertia,
        gear.caster_length,
        tyre.half_contact_length,
        tyre.relaxation_length,
        tyre.tread_width_moment,
    )
    M_a = (e * 7 * tyre.cornering_coefficient + tyre.aligning_coefficient) * F_z
    quadratic = [s / V, I_z + s * (k_psi * s + M_a * (e - a)) / V**2, I_z / V * M_a * (e - a - s)]
    return max(np.roots(quadratic).real) - kappa / V


@pytest.fixture
def one_variable(main_gear):
    """The main gear without lateral mode, with springs and links given."""
    return main_gear.replace(
        damper__topology="boeing",
        gear__order=3,
        requirements__stability_margin=0.0,
        design__k_lambda=3.8e6,
        design__L=0.6,
        design__gamma=np.deg2rad(31),
        solver__margin_reserve=RESERVE,
        solver__starts=4,
    )


@pytest.mark.parametrize("speed", [5.0, 20.0, 80.0])
def test_one_speed(one_variable, speed):
    study = one_variable.replace(envelope__speed={"min": speed, "max": speed})
    result = damperopt.optimise(study)
    k_psi = result.derived["torsional_stiffness"]
    expected = closed_form_damping(study, k_psi, speed, 150e3)
    assert result.status == "solved"
    assert result.derived["torsional_damping"] == pytest.approx(expected, rel=1e-6)


def test_speed_range(one_variable):
    result = damperopt.optimise(one_variable)
    k_psi = result.derived["torsional_stiffness"]
    worst = minimize_scalar(
        lambda V: -closed_form_damping(one_variable, k_psi, V, 150e3),
        bounds=(5, 100),
        method="bounded",
        options={"xatol": 1e-9},
    )
    assert result.status == "solved"
    assert result.derived["torsional_damping"] == pytest.approx(-worst.fun, rel=1e-6)
    assert result.stability.speed == pytest.approx(worst.x, rel=1e-3)


def test_all_but_stability_free_at_the_closed_form_border(one_variable):
    """With everything free again the border of the third-order gear still holds at the optimum."""
    free = one_variable.replace(design__k_lambda={"start": 3.8e6, "min": 1e5, "max": 1e9}, solver__starts=8)
    result = damperopt.optimise(free)
    border = max(
        closed_form_damping(free, result.derived["torsional_stiffness"], V, 150e3) for V in np.geomspace(5, 100, 20001)
    )
    assert result.derived["torsional_damping"] == pytest.approx(border, rel=1e-5)
