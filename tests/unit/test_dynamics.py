"""Equations of motion: the composed model against the basic twin, its linearisation, signs and symmetry."""

import casadi as ca
import numpy as np
import pytest
from basic_twin import (
    LAYOUT,
    effective_caster,
    jacobian,
    parameters,
    planar_coefficients,
    planar_torque,
    published_coefficients,
    right_hand_side,
    state_matrix,
)
from components_of import TWIN_LAWS, damper_block, gear_of
from tolerances import CENTRAL_DIFFERENCE, CENTRAL_DIFFERENCE_STEP, ROUNDING, SAME_EQUATIONS

from damperopt import dynamics
from damperopt.expressions.corners import Smooth
from damperopt.stability.linear import LinearModel, linearise
from damperopt.symbols import data_values, symbolic

TYRES = {
    "nonlinear": {
        "law": "nonlinear",
        "contact": "leading_point",
        "half_contact_length": 0.1,
        "relaxation_length": 0.3,
        "tread_width_moment": 570.0,
        "cornering_coefficient": 0.002,
        "aligning_coefficient": 1.0,
        "aligning_slip_limit": np.deg2rad(10.0),
    },
    "stiff nonlinear": {
        "law": "nonlinear",
        "contact": "leading_point",
        "half_contact_length": 0.15,
        "relaxation_length": 0.35,
        "tread_width_moment": 100.0,
        "cornering_coefficient": 0.3,
        "aligning_coefficient": -0.4,
        "aligning_slip_limit": 0.3,
    },
    "linear": {
        "law": "linear",
        "contact": "leading_point",
        "half_contact_length": 0.12,
        "relaxation_length": 0.25,
        "tread_width_moment": 270.0,
        "cornering_slope": 12.0,
        "aligning_coefficient": 0.5,
    },
    "straight_tangent": {
        "law": "stiffness",
        "contact": "leading_point",
        "half_contact_length": 0.1,
        "relaxation_length": 0.4,
        "cornering_stiffness": 4.0e5,
        "aligning_stiffness": 3.0e4,
    },
}

DAMPERS = {
    "rotational": {"topology": "rotational", "torsional_stiffness": 3.8e5, "torsional_damping": 300.0},
    "boeing": damper_block("boeing"),
    "utas": damper_block("utas"),
    "arreaza": damper_block("arreaza"),
    "published boeing": damper_block("boeing", geometry="published"),
    "published utas": damper_block("utas", geometry="published"),
    "published arreaza": damper_block("arreaza", geometry="published"),
}

COMBINATIONS = [("rotational", tyre) for tyre in TYRES] + [
    (damper, "nonlinear") for damper in DAMPERS if damper != "rotational"
]
"""Every tyre law with one damper, every damper with one law: the two meet in a sum only."""

DESIGN = LAYOUT | {"c_lambda": 2.0e4, "k_lambda": 3.8e6, "I_arm": 3.4e-6}
E_STEEL = 207e9


@pytest.fixture(params=[3, 5], ids=["third-order", "fifth-order"])
def order(request):
    return request.param


@pytest.fixture(params=[0.0, 0.1571, -0.1], ids=["no-rake", "rake", "negative-rake"])
def rake(request):
    return request.param


@pytest.fixture
def study(main_gear):
    """The main gear with E = 207 GPa and some blocks replaced."""

    def change(damper="rotational", tyre="nonlinear", order=5, rake=0.0):
        return main_gear.replace(
            gear__order=order,
            gear__rake_angle=rake,
            tyre=TYRES[tyre],
            damper=DAMPERS[damper],
            material={"youngs_modulus": E_STEEL, "density": 7850.0, "yield_strength": 1e9},
            requirements__limit_torque=1e4,
        )

    return change


@pytest.fixture
def random():
    return np.random.default_rng(2009)


def package(study):
    """x' of the package as a function of (x, V, F_z), with the numbers of `study` and DESIGN."""
    dae = dynamics.build(symbolic(study), Smooth())
    function = ca.Function("ode", [dae.x, dae.design, dae.speed, dae.load, dae.data, dae.yaw_torque], [dae.ode])
    design = [DESIGN[name] for name in dae.design_names]

    def ode(x, V=40.0, F_z=150e3):
        return function(x, design, V, F_z, data_values(study), 0.0).full().ravel()

    return ode


def twin(study):
    """Parameters of the basic twin for the same gear."""
    gear, tyre, damper, lateral = study.gear, study.tyre, study.damper, study.gear.lateral
    if damper.topology == "rotational":
        (k_psi, c_psi), torque = (damper.torsional_stiffness, damper.torsional_damping), None
    elif damper.geometry == "published":
        k_psi, c_psi = published_coefficients(damper.topology, E_STEEL, **DESIGN)
        torque = None
    else:
        k_psi, c_psi = planar_coefficients(damper.topology, E_STEEL, **DESIGN)
        torque = planar_torque(damper.topology, E_STEEL, **DESIGN)
    slopes = {
        "arctangent": ("cornering_coefficient", "aligning_coefficient"),
        "linear": ("cornering_slope", "aligning_coefficient"),
        "stiffness": ("cornering_stiffness", "aligning_stiffness"),
    }[tyre.law]
    return parameters(
        I_z=gear.yaw_inertia,
        e=gear.caster_length,
        phi=gear.rake_angle,
        R_w=gear.wheel_radius,
        I_x=lateral.inertia,
        k_delta=lateral.stiffness,
        c_delta=lateral.damping,
        l_g=lateral.height,
        a=tyre.half_contact_length,
        sigma=tyre.relaxation_length,
        kappa=tyre.tread_width_moment,
        law=TWIN_LAWS[tyre.law],
        C_F=getattr(tyre, slopes[0]),
        C_M=getattr(tyre, slopes[1]),
        alpha_m=getattr(tyre, "aligning_slip_limit", None),
        k_psi=k_psi,
        c_psi=c_psi,
        torque=torque,
    )


def random_states(random, order, count):
    """States of large motion: yaw to 0.5 rad, string deflection to 0.3 m, which is beyond every slip limit."""
    size = np.array([0.5, 30.0, 0.2, 10.0, 0.3])
    return random.uniform(-1, 1, (count, order)) * (size if order == 5 else size[[0, 1, 4]])


# ------------------------------------------------------------------------------------------------- against the twin


@pytest.mark.parametrize(("damper", "tyre"), COMBINATIONS)
def test_equations_of_motion_are_those_of_the_twin(study, random, order, rake, damper, tyre):
    changed = study(damper=damper, tyre=tyre, order=order, rake=rake)
    ode, p = package(changed), twin(changed)
    for x in random_states(random, order, 20):
        V, F_z = random.uniform(2.0, 200.0), random.uniform(20e3, 400e3)
        expected = right_hand_side(x, V, F_z, p)
        np.testing.assert_allclose(ode(x, V, F_z), expected, rtol=SAME_EQUATIONS, atol=SAME_EQUATIONS * abs(expected).max())


@pytest.mark.parametrize(("damper", "tyre"), COMBINATIONS)
def test_state_matrix_is_that_of_the_twin(study, random, order, rake, damper, tyre):
    """The twin's matrix is worked out by hand and knows nothing of the torque of a linkage but k_psi and c_psi."""
    changed = study(damper=damper, tyre=tyre, order=order, rake=rake)
    model = LinearModel(changed)
    gear = model.at({name: DESIGN[name] for name in model.design_names})
    speeds, loads = random.uniform(2.0, 200.0, 3), random.uniform(20e3, 400e3, 3)
    expected = np.array([state_matrix(V, F_z, twin(changed), order) for V, F_z in zip(speeds, loads, strict=True)])
    np.testing.assert_allclose(gear.matrices(speeds, loads), expected, rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize("tyre", TYRES)
def test_state_matrix_of_the_twin_is_its_jacobian(study, order, rake, tyre):
    """Complex steps through the nonlinear equations against the matrix by hand; UTAS, whose torque is the least simple."""
    p = twin(study(damper="utas", tyre=tyre, order=order, rake=rake))
    A = jacobian(np.zeros(order), 40.0, 150e3, p)
    np.testing.assert_allclose(A, state_matrix(40.0, 150e3, p, order), rtol=ROUNDING, atol=ROUNDING)


@pytest.mark.parametrize(("damper", "tyre"), COMBINATIONS)
def test_state_matrix_is_the_finite_difference_of_the_equations_of_motion(study, order, rake, damper, tyre):
    changed = study(damper=damper, tyre=tyre, order=order, rake=rake)
    ode, h = package(changed), CENTRAL_DIFFERENCE_STEP
    differences = np.array([(ode(h * unit) - ode(-h * unit)) / (2 * h) for unit in np.eye(order)]).T
    dae = dynamics.build(symbolic(changed))
    A = linearise(dae)([DESIGN[name] for name in dae.design_names], 40.0, 150e3, data_values(changed)).full()
    for row, expected in zip(differences, A, strict=True):
        np.testing.assert_allclose(row, expected, atol=CENTRAL_DIFFERENCE * abs(expected).max())


def test_rest_is_an_equilibrium(study, order, rake):
    for damper in DAMPERS:
        assert not package(study(damper=damper, order=order, rake=rake))(np.zeros(order)).any()


def test_effective_caster_with_rake():
    """e 0.12 m, R_w 0.362 m at 9 deg: 0.118523 + (0.362 + 0.018772) 0.158384 = 0.178831 m, by hand; the caster itself at 0."""
    numbers = {"kind": "yaw", "yaw_inertia": 1.0, "caster_length": 0.12, "wheel_radius": 0.362}
    assert gear_of(**numbers, rake_angle="9 deg").lever() == pytest.approx(0.178831, abs=1e-6)
    assert effective_caster(parameters(phi=np.deg2rad(9.0))) == pytest.approx(0.178831, abs=1e-6)
    assert gear_of(**numbers).lever() == 0.12


# ----------------------------------------------------------------------------------------------------------- signs


@pytest.fixture
def rates(study):
    """x' of the five-state main gear by name, at a state given by name; the other states are zero."""

    def at(V=40.0, F_z=150e3, rake=0.0, damper="rotational", tyre="nonlinear", **state):
        changed = study(damper=damper, tyre=tyre, rake=rake)
        names = dynamics.build(symbolic(changed)).state_names
        values = package(changed)([state.get(name, 0.0) for name in names], V, F_z)
        return dict(zip(names, values, strict=True))

    return at


def test_states_are_named_in_order(study):
    assert dynamics.build(symbolic(study(order=3))).state_names == ("yaw_angle", "yaw_rate", "string_deflection")
    fifth = ("yaw_angle", "yaw_rate", "bending_angle", "bending_rate", "string_deflection")
    assert dynamics.build(symbolic(study(order=5))).state_names == fifth


def test_rates_are_the_derivatives_of_their_angles(rates):
    found = rates(yaw_rate=2.0, bending_rate=-3.0)
    assert (found["yaw_angle"], found["bending_angle"]) == (2.0, -3.0)


def test_positive_yaw_at_speed_builds_positive_string_deflection(rates):
    """V sin(psi), nothing else."""
    assert rates(yaw_angle=0.1, V=40.0)["string_deflection"] == pytest.approx(40.0 * np.sin(0.1), rel=ROUNDING)


def test_string_relaxes_over_the_relaxation_length(rates):
    """At the rate V/sigma, the faster the gear rolls."""
    assert rates(string_deflection=0.01, V=60.0)["string_deflection"] == pytest.approx(-60.0 / 0.3 * 0.01, rel=ROUNDING)


def test_yaw_rate_moves_the_leading_point_by_caster_less_half_contact_length(rates):
    assert rates(yaw_rate=1.0)["string_deflection"] == pytest.approx(0.12 - 0.1, rel=ROUNDING)


def test_bending_rate_moves_the_leading_point_by_the_height_of_the_gear(rates):
    assert rates(bending_rate=1.0)["string_deflection"] == pytest.approx(2.5, rel=ROUNDING)


@pytest.mark.parametrize("tyre", ["nonlinear", "linear", "straight_tangent"])
@pytest.mark.parametrize("deflection", [0.02, -0.02])
def test_deflected_string_turns_the_wheel_back_and_bends_the_strut_back(rates, tyre, deflection):
    """Side force on a trailing caster and aligning moment restore a yaw that has built the deflection; so does the bending."""
    found = rates(tyre=tyre, string_deflection=deflection)
    assert np.sign(found["yaw_rate"]) == np.sign(found["bending_rate"]) == -np.sign(deflection)


def test_aligning_moment_alone_restores(main_gear):
    """No side force: I_z psi'' = -C_M (alpha_m/pi) sin(pi alpha/alpha_m) F_z."""
    damper = DAMPERS["rotational"]
    found = package(main_gear.replace(tyre__cornering_coefficient=0.0, damper=damper))([0, 0, 0, 0, 0.02])
    alpha, alpha_m = np.arctan(0.02 / 0.3), np.deg2rad(10.0)
    expected = -alpha_m / np.pi * np.sin(np.pi * alpha / alpha_m) * 150e3 / 100.0
    assert found[1] == pytest.approx(expected, rel=ROUNDING)
    assert found[3] == 0


def test_side_force_alone_restores_with_the_lever_of_the_caster(main_gear):
    """No aligning moment: I_z psi'' = -e F_y and I_x delta'' = -l_g F_y, with one and the same F_y."""
    damper = DAMPERS["rotational"]
    found = package(main_gear.replace(tyre__aligning_coefficient=0.0, damper=damper))([0, 0, 0, 0, 0.02])
    F_y = -found[3] * 600.0 / 2.5
    assert F_y > 0
    assert found[1] == pytest.approx(-0.12 * F_y / 100.0, rel=ROUNDING)


def test_spring_and_damper_of_every_layout_oppose_yaw(rates):
    for damper in DAMPERS:
        assert rates(damper=damper, yaw_angle=0.1, F_z=1e-3)["yaw_rate"] < 0
        assert rates(damper=damper, yaw_rate=1.0, V=1e9)["yaw_rate"] < 0


def test_tread_width_moment_opposes_yaw_rate_and_fades_with_speed(rates):
    """kappa psi'/V: the yaw damping is c_psi + kappa/V."""
    slow, fast = (rates(yaw_rate=1.0, V=V)["yaw_rate"] * 100.0 for V in (10.0, 1e9))
    assert fast == pytest.approx(-300.0, rel=1e-6)
    assert slow == pytest.approx(-(300.0 + 570.0 / 10.0), rel=ROUNDING)


def test_load_on_a_yawed_caster_bends_the_strut_to_the_same_side(rates):
    """I_x delta'' = F_z e sin(psi)."""
    assert rates(yaw_angle=0.1)["bending_rate"] == pytest.approx(150e3 * 0.12 * np.sin(0.1) / 600.0, rel=ROUNDING)


def test_load_turns_a_raked_gear_further(rates):
    """F_z sin(phi) e_eff sin(theta): against the spring for positive rake; none without rake."""
    light, heavy = (rates(yaw_angle=0.1, rake=0.1571, F_z=F_z)["yaw_rate"] for F_z in (1e3, 150e3))
    assert heavy > light
    assert rates(yaw_angle=0.1, F_z=1e3)["yaw_rate"] == rates(yaw_angle=0.1, F_z=150e3)["yaw_rate"]


def test_lateral_spring_and_damper_oppose_bending(rates):
    assert rates(bending_angle=0.01)["bending_rate"] == pytest.approx(-6.1e6 * 0.01 / 600.0, rel=ROUNDING)
    assert rates(bending_rate=1.0)["bending_rate"] == pytest.approx(-300.0 / 600.0, rel=ROUNDING)


# -------------------------------------------------------------------------------------------------------- symmetry


@pytest.mark.parametrize(("damper", "tyre"), [pair for pair in COMBINATIONS if pair[0] != "utas"])
def test_mirrored_state_has_the_mirrored_rates(study, random, order, rake, damper, tyre):
    """ode(-x) = -ode(x), for `published` UTAS as well, whose damping is a constant."""
    ode = package(study(damper=damper, tyre=tyre, order=order, rake=rake))
    for x in random_states(random, order, 5):
        scale = abs(ode(x)).max()
        np.testing.assert_allclose(ode(-x), -ode(x), rtol=ROUNDING, atol=ROUNDING * scale)


def test_planar_utas_breaks_the_mirror_in_the_yaw_equation_only(study, random, order):
    """Its damper has the longer lever on the side to which it shortens; spring and tyre are symmetric."""
    ode = package(study(damper="utas", order=order))
    for x in random_states(random, order, 5):
        broken = abs(ode(x) + ode(-x)) > ROUNDING * abs(ode(x)).max()
        assert broken.tolist() == [i == 1 for i in range(order)]
        at_rest = x * [0 if i == 1 else 1 for i in range(order)]
        np.testing.assert_allclose(ode(-at_rest), -ode(at_rest), rtol=ROUNDING, atol=ROUNDING * abs(ode(x)).max())


def test_planar_utas_damps_more_where_the_damper_shortens(rates):
    """Lever ell b cos(psi)/s(psi), the damper length s being shorter for positive yaw."""
    left, right, middle = (
        rates(damper="utas", yaw_angle=angle, yaw_rate=1.0)["yaw_rate"] - rates(damper="utas", yaw_angle=angle)["yaw_rate"]
        for angle in (0.3, -0.3, 0.0)
    )
    assert left < middle < right < 0
