"""Damper layouts: levers against the geometry seen from the top, torque against energy and power."""

import casadi as ca
import numpy as np
import pytest
from basic_twin import LAYOUT, planar_coefficients, planar_torque, published_coefficients
from components_of import coefficients_of, damper_of
from scipy.integrate import quad
from tolerances import CENTRAL_DIFFERENCE, CENTRAL_DIFFERENCE_STEP, QUADRATURE, ROUNDING

E = 207e9
DESIGN = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
ELL, B = 0.6 * np.sin(np.deg2rad(31.0)), 0.2
R = np.hypot(ELL, B)
ANGLES = [-0.4, -0.1, 0.0, 0.2, 0.5]


@pytest.fixture(params=["boeing", "utas", "arreaza"])
def topology(request):
    return request.param


@pytest.fixture
def planar(topology):
    return linkage_of(topology=topology)


@pytest.fixture
def published(topology):
    return linkage_of(topology=topology, geometry="published")


def linkage_of(**block):
    return damper_of(**block).linkage(DESIGN, E)


def number(expression):
    return float(ca.evalf(ca.SX(expression)))


def torque(found, psi, rate, c_lambda=DESIGN["c_lambda"]):
    """Virtual work of the spring force along the deflection and of the damper force along the stroke."""
    at = found.at(psi)
    spring, damper = found.stiffness * at.deflection, found.as_printed.get("c_lambda", c_lambda) * at.damper_lever * rate
    return -number(spring * at.spring_lever + damper * at.damper_lever)


# -------------------------------------------------------------------- geometry from the top: strut axis at the origin


def spring_deflection(topology, psi):
    """Deflection of the spring, or of the arm's tip across the arm, when the apex has moved sideways by ell sin(psi)."""
    sideways = np.array([0.0, ELL * np.sin(psi)])
    if topology == "utas":
        across = np.array([B, ELL]) / R  # unit vector across the arm from (0, B) to the apex at rest (ELL, 0)
        return sideways @ across
    return sideways[1]


def damper_length(topology, psi):
    """Pin-to-pin length of the damper, up to a constant; UTAS: apex on its circle about the strut axis, root at (0, B)."""
    if topology == "utas":
        return np.linalg.norm([ELL * np.cos(psi), ELL * np.sin(psi) - B])
    return -ELL * np.sin(psi)


def spring_stiffness(topology):
    """Spring of Boeing, else tip stiffness 3 E I/length^3 of the arm."""
    length = {"boeing": None, "utas": R, "arreaza": ELL}[topology]
    return DESIGN["k_lambda"] if length is None else 3 * E * DESIGN["I_arm"] / length**3


def derivative(function, psi):
    h = CENTRAL_DIFFERENCE_STEP
    return (function(psi + h) - function(psi - h)) / (2 * h)


def test_levers_are_derivatives_of_the_lengths(topology, planar):
    eps = derivative(lambda psi: spring_deflection(topology, psi), 0.0)
    s = derivative(lambda psi: damper_length(topology, psi), 0.0)
    assert number(planar.spring_lever) == pytest.approx(eps, rel=CENTRAL_DIFFERENCE)
    assert abs(number(planar.damper_lever)) == pytest.approx(abs(s), rel=CENTRAL_DIFFERENCE)


def test_planar_utas_levers_by_hand():
    """ell 0.30902, b 0.2, R 0.36810 m: eps lever ell^2/R = 0.25943 m, damper lever ell b/R = 0.16790 m."""
    found = linkage_of(topology="utas")
    assert number(found.spring_lever) == pytest.approx(0.25943, abs=1e-5)
    assert number(found.damper_lever) == pytest.approx(0.16790, abs=1e-5)


def test_torque_of_the_spring_does_the_work_that_the_spring_stores(topology, planar):
    """-integral of the torque at rest from 0 to psi = k_eps eps(psi)^2/2."""
    for psi in ANGLES:
        work = -quad(lambda angle: torque(planar, angle, 0.0), 0.0, psi)[0]
        stored = spring_stiffness(topology) * spring_deflection(topology, psi) ** 2 / 2
        assert work == pytest.approx(stored, rel=QUADRATURE, abs=1e-9)


def test_torque_of_the_damper_has_the_power_that_the_damper_burns(topology, planar):
    """-torque psi' = c_lambda (ds/dt)^2 at every angle, for either direction."""
    for psi in ANGLES:
        for rate in (-3.0, 0.5):
            burnt = DESIGN["c_lambda"] * (derivative(lambda angle: damper_length(topology, angle), psi) * rate) ** 2
            power = -(torque(planar, psi, rate) - torque(planar, psi, 0.0)) * rate
            assert power == pytest.approx(burnt, rel=CENTRAL_DIFFERENCE)
            assert power > 0


@pytest.mark.parametrize("geometry", ["planar", "published"])
def test_stiffness_and_damping_are_the_linear_part_of_the_torque(topology, geometry):
    damper = damper_of(topology=topology, geometry=geometry)
    found, (stiffness, damping) = damper.linkage(DESIGN, E), coefficients_of(damper, DESIGN, E)
    k_psi = -derivative(lambda psi: torque(found, psi, 0.0), 0.0)
    c_psi = -torque(found, 0.0, 1.0)
    assert stiffness == pytest.approx(k_psi, rel=CENTRAL_DIFFERENCE)
    assert damping == pytest.approx(c_psi, rel=ROUNDING)


def test_planar_torque_is_that_of_the_twin(topology, planar):
    twin = planar_torque(topology, E, **DESIGN)
    for psi in ANGLES:
        for rate in (-3.0, 0.5):
            assert torque(planar, psi, rate) == pytest.approx(twin(psi, rate), rel=ROUNDING)


def test_planar_coefficients_by_the_formulas_of_the_theory_page(topology):
    """Section 3; for UTAS k = (3 E I/R^3)(ell sin(alpha_arm))^2 and c = c_lambda ell^2 b^2/R^2."""
    expected = planar_coefficients(topology, E, **DESIGN)
    assert coefficients_of(damper_of(topology=topology), DESIGN, E) == pytest.approx(expected, rel=ROUNDING)


def test_planar_utas_damping_over_the_yaw_angle():
    """Section 3: (ds/dpsi)^2 = ell^2 b^2 cos^2(psi)/s^2 with s^2 = ell^2 + b^2 - 2 ell b sin(psi)."""
    found = linkage_of(topology="utas")
    for psi in ANGLES:
        lever2 = (ELL * B * np.cos(psi)) ** 2 / (ELL**2 + B**2 - 2 * ELL * B * np.sin(psi))
        damping = torque(found, psi, 0.0) - torque(found, psi, 1.0)
        assert damping == pytest.approx(DESIGN["c_lambda"] * lever2, rel=ROUNDING)


def test_planar_utas_torque_is_asymmetric():
    """The others are odd in (psi, psi'); the damper of UTAS has the longer lever where it shortens."""
    for name in ("boeing", "utas", "arreaza"):
        found = linkage_of(topology=name)
        left, right = torque(found, 0.3, 2.0), torque(found, -0.3, -2.0)
        if name == "utas":
            assert left < -right - 1.0
        else:
            assert left == pytest.approx(-right, rel=ROUNDING)


def test_arm_stiffness_of_the_new_design_is_that_of_a_cantilever():
    """Double integral of the curvature under a unit tip force gives the tip stiffness; ell is both arm and lever."""
    flexibility = quad(lambda x: (ELL - x) ** 2 / (E * DESIGN["I_arm"]), 0.0, ELL)[0]
    found = linkage_of(topology="arreaza")
    assert number(found.torsional_stiffness) == pytest.approx(ELL**2 / flexibility, rel=QUADRATURE)


def test_published_torque_is_linear_with_the_printed_coefficients(topology, published):
    k_psi, c_psi = published_coefficients(topology, E, **DESIGN)
    for psi in ANGLES:
        assert torque(published, psi, 2.0) == pytest.approx(-k_psi * psi - 2.0 * c_psi, rel=ROUNDING)


def test_published_geometry_keeps_levers_and_lengths_of_the_planar_one(planar, published):
    """Strokes and stresses are taken from the true levers, whatever stiffness is printed."""
    for name in ("spring_lever", "damper_lever", "reach"):
        assert number(getattr(published, name)) == number(getattr(planar, name))
    assert (published.arm_length, published.damper_length) == (planar.arm_length, planar.damper_length)


def test_lengths_seen_from_the_top():
    lengths = {name: linkage_of(topology=name) for name in ("boeing", "utas", "arreaza")}
    assert all(number(found.reach) == pytest.approx(ELL, rel=ROUNDING) for found in lengths.values())
    assert (lengths["boeing"].arm_length, lengths["boeing"].damper_length) == (None, None)
    assert (number(lengths["utas"].arm_length), number(lengths["utas"].damper_length)) == pytest.approx((R, R), rel=ROUNDING)
    assert (number(lengths["arreaza"].arm_length), number(lengths["arreaza"].damper_length)) == pytest.approx(
        (ELL, B), rel=ROUNDING
    )


def test_rotational_damper_is_what_it_is_given():
    damper = damper_of(topology="rotational", torsional_stiffness=3.8e5, torsional_damping=300.0)
    assert coefficients_of(damper, {}, E) == (3.8e5, 300.0)
    assert torque(damper.linkage({}, E), 0.1, 2.0, 300.0) == pytest.approx(-3.8e4 - 600.0, rel=ROUNDING)


@pytest.mark.parametrize("geometry", ["planar", "published"])
def test_damping_is_proportional_to_the_damper_and_stiffness_to_the_spring(topology, geometry):
    """And neither depends on the other."""

    def coefficients(**changes):
        return coefficients_of(damper_of(topology=topology, geometry=geometry), DESIGN | changes, E)

    spring = "k_lambda" if topology == "boeing" else "I_arm"
    k_psi, c_psi = coefficients()
    assert coefficients(**{spring: 3 * DESIGN[spring]}) == pytest.approx((3 * k_psi, c_psi), rel=ROUNDING)
    assert coefficients(c_lambda=3 * DESIGN["c_lambda"]) == pytest.approx((k_psi, 3 * c_psi), rel=ROUNDING)
