"""Ways to be light on paper: each is tried on the default main gear, and a row or a mass answers."""

import math

import numpy as np
import pytest
from own_studies import study_block

import damperopt
from damperopt.optimum.problem import DesignProblem
from damperopt.ports.section import Section
from damperopt.strength.buckling import least_lateral_inertia, local_buckling_stress, weak_axis
from damperopt.strength.materials import Material
from damperopt.study.study import Study

STEEL = Material.model_validate("AISI 4340")
DESIGNS = {
    "boeing": {"c_lambda": 3e4, "k_lambda": 4e6},
    "utas": {"c_lambda": 3e4, "I_arm": 1.1e-6, "b": 0.18},
    "arreaza": {"c_lambda": 3e4, "I_arm": 1.1e-6, "b": 0.18, "A_support": 1.7e-4, "I_foot": 3e-7},
}
THIN = [
    {"family": "tube", "thickness_ratio": 0.002},
    {"family": "i_section", "thickness_ratio": 0.004, "aspect_ratio": 1.0},
]
REST = {
    "L": 0.56,
    "gamma": 0.75,
    "A_link": 2.3e-4,
    "I_hinge": 4e-7,
    "A_piston": 7e-4,
    "rod_diameter": 0.012,
    "s_damper": 0.0102,
}


def problem(configs, topology, **changes):
    study = damperopt.load(configs / "main_gear.yaml").replace(damper__topology=topology, requirements__decay=None, **changes)
    return DesignProblem(study), {**REST, **DESIGNS[topology]}


def rows(configs, topology, changes=None, **design):
    found, at = problem(configs, topology, **(changes or {}))
    return found.rows(at | design)


@pytest.mark.parametrize("topology", DESIGNS)
def test_stroke_is_asked_at_a_torque(configs, topology):
    """A stiffer spring has less of it; no factor and no load gives it back."""
    spring = "k_lambda" if topology == "boeing" else "I_arm"
    soft = rows(configs, topology)["working_stroke"]
    stiff = rows(configs, topology, **{spring: 10 * DESIGNS[topology][spring]})["working_stroke"]
    less = math.log(10)
    if topology == "utas":  # of a tube ten times as stiff in bending the area is but sqrt(10) times as large
        inertia, b = DESIGNS[topology]["I_arm"], DESIGNS[topology]["b"]
        less += math.log(stroke_along(inertia, b) / stroke_along(10 * inertia, b))
    assert stiff == pytest.approx(soft + less)
    for changes in (
        {"requirements__limit_torque_factor": 3.0},
        {"requirements__ultimate_factor": 2.0},
        {"loads__cases": ["turning"]},
    ):
        assert rows(configs, topology, changes)["working_stroke"] == pytest.approx(soft)


@pytest.mark.parametrize("topology", DESIGNS)
def test_hinges_are_as_wide_as_the_strut_has_room(configs, topology):
    links = {"form": "a_frame", "hinge_width_max": 0.25}
    row = rows(configs, topology, {"damper__links": links})["hinge_width"]
    assert row == pytest.approx(0.56 / 2 - 0.25)
    with pytest.raises(damperopt.ConfigError, match="hinge_width"):
        rows(configs, topology, {"damper__links": links | {"hinge_width": 0.3}})


def beside(half):
    """What a beam out to `half` has beside a strut 0.14 m wide, with a corner of 3 mm."""
    return (half - 0.07 + math.hypot(half - 0.07, 0.006)) / 2


def along(inertia, b):
    """m/b = n/a of UTAS' arm and of the half beam beside it, tubes of 1/10: give along themselves over that in bending."""
    length = math.hypot(0.56, b)
    outer = (64 * inertia / math.pi / (1 - 0.8**4)) ** 0.25
    area = math.pi / 4 * outer**2 * (1 - 0.8**2)
    return 3 * inertia / length**2 / (1 + 3 * beside(b) / length) / area / 0.56


def pushed(inertia, b):
    """Factor on the deflection of its tip."""
    length = math.hypot(0.56, b)
    return 1 + along(inertia, b) * (b**2 + beside(b) * length) / 0.56


def stroke_along(inertia, b):
    """Stroke of its damper over that of a gear whose arm keeps its length, but for a constant."""
    length, over = math.hypot(0.56, b), beside(b)
    retreat = 3 * over**2 / (2 * length * (length + 3 * over)) + along(inertia, b) * b * (length + over) / 0.56
    return pushed(inertia, b) * (2 * b / length - retreat)


def test_roots_beside_the_axis_hang_on_a_beam(configs):
    """Weighed, twice what b leaves beside the strut, of the arm's section, and as soft as it is long."""
    found, at = problem(configs, "utas")
    parts = [found.parts(at | {"b": b}) for b in (0.1, 0.3)]
    near, far = (beside(half) for half in (0.1, 0.3))
    assert parts[1]["hinge line"] == pytest.approx(far / near * parts[0]["hinge line"])
    stiffness = found.yaw_numbers(at | {"b": 0.3})["torsional_stiffness"]
    length = math.hypot(0.56, 0.3)
    clamped = 3 * 207e9 * 1.1e-6 / length**3 * (0.56 * math.sin(0.75) * length / 0.56) ** 2
    assert stiffness == pytest.approx(clamped / (1 + 3 * far / length) / pushed(1.1e-6, 0.3))


@pytest.mark.parametrize("topology", DESIGNS)
def test_a_wide_hinge_hangs_on_a_long_beam(configs, topology):
    """Of legs twice as far apart the beam is more than twice as heavy, bends more, and never has no length."""
    narrow, wide, none = ({"damper__links": {"hinge_width": width, "strut_width": 0.14}} for width in (0.24, 0.48, 0.1))
    weights = [
        problem(configs, topology, **changes)[0].parts({**REST, **DESIGNS[topology]}) for changes in (narrow, wide, none)
    ]
    beams = [parts["link hinges"] for parts in weights]
    a, b, least = beside(0.12), beside(0.24), beside(0.05)
    assert beams[1] == pytest.approx(b / a * beams[0])
    assert beams[2] == pytest.approx(least / a * beams[0])
    assert 0 < least < 0.003
    asked = [rows(configs, topology, changes)["hinge_limit"] for changes in (narrow, wide)]
    F = 14.4e3 / (0.56 * math.sin(0.75))
    bent = [
        F * 0.56 * a / w / (math.pi / 32 * 0.5904 * (4e-7 * 64 / math.pi / 0.5904) ** 0.75) for a, w in ((a, 0.24), (b, 0.48))
    ]
    pushed = F / 2 / math.sqrt(4e-7 * 16 * math.pi * 0.09 / 1.64)
    assert asked == pytest.approx([4 / 3 * math.log((one + pushed) / 1103e6) for one in bent])


def test_nothing_rests_on_a_stop(configs):
    """A stop inside the stroke of the limit torque would carry part of it: it is not sized."""
    for topology in DESIGNS:
        stroke = problem(configs, topology)[0].limit_event({**REST, **DESIGNS[topology]})["damper_stroke"]
        for ratio in (0.8, 1.2):
            stop = {"stroke": ratio * stroke, "stiffness": 5e7}
            assert rows(configs, topology, {"damper__end_stop": stop})["end_stop"] == pytest.approx(-math.log(ratio))


@pytest.mark.parametrize("topology", DESIGNS)
def test_a_damper_has_parts_that_no_size_changes(configs, topology):
    found, at = problem(configs, topology)
    without, _ = problem(configs, topology, mass__damper_fixed_mass=0.0)
    assert found.parts(at)["damper"] == pytest.approx(without.parts(at)["damper"] + 1.0)


@pytest.mark.parametrize("topology", DESIGNS)
def test_a_damper_has_a_length(configs, topology):
    """Three strokes, the dead length and a bore; across the apex in the room that the bay has."""
    bore = math.sqrt(4 * 7e-4 / math.pi + 0.012**2)
    needed = 3 * 0.0102 + 0.12 + bore
    if topology == "boeing":
        assert rows(configs, topology, {"requirements__apex_room": 0.15})["apex_room"] == pytest.approx(needed - 0.15)
        return
    length = 0.18 if topology == "arreaza" else math.hypot(0.56, 0.18)
    assert rows(configs, topology)["damper_length"] == pytest.approx(needed - length)


@pytest.mark.parametrize("shape", THIN, ids=lambda shape: shape["family"])
def test_thin_walls_buckle(configs, shape):
    """A lighter arm and lighter links of the same second moment are refused."""
    found, at = problem(configs, "arreaza", mass__arm_section=shape, mass__link_section=shape)
    usual, _ = problem(configs, "arreaza")
    assert found.parts(at)["bending arm"] < 0.5 * usual.parts(at)["bending arm"]
    assert found.rows(at)["arm_wall"] > 0
    assert found.rows(at)["link_wall"] > 0
    assert usual.rows(at)["arm_wall"] < -3


def test_flange_is_a_plate_with_a_free_edge():
    """sigma = 0.43 pi^2 E/(12 (1 - nu^2)) (t/c)^2: t 2 mm, c (100 - 2)/2 mm."""
    section = Section(family="i_section", thickness_ratio=0.02, aspect_ratio=1.0)
    expected = 0.43 * math.pi**2 * 207e9 / (12 * 0.91) * (2 / 49) ** 2
    assert local_buckling_stress(section, STEEL, "axial") == pytest.approx(expected)


def test_a_plate_tips_over():
    """Prandtl's P = 4.013 sqrt(E I_y G J)/L^2 of a deep narrow plate, 5 x 100 mm, 1 m: J = h b^3/3 (1 - 0.63 b/h)."""
    h, b, L = 0.1, 0.005, 1.0
    J = h * b**3 / 3 * (1 - 0.63 * b / h)
    force = 4.013 * math.sqrt(207e9 * h * b**3 / 12 * 207e9 / 2.6 * J) / L**2
    section = Section(family="rectangle", aspect_ratio=20.0)
    assert least_lateral_inertia(section, STEEL, force * L, L) == pytest.approx(b * h**3 / 12)
    assert weak_axis(section) == pytest.approx(1 / 400)
    assert weak_axis(Section(family="tube", thickness_ratio=0.1)) == 1


def test_a_leg_buckles_about_its_weak_axis(configs):
    """Bars ten times as deep as wide are as slender as they are narrow."""
    section = {"family": "rectangle", "aspect_ratio": 10.0}
    found, at = problem(configs, "arreaza", mass__link_section=section)
    leg, force = (
        math.hypot(0.56, 0.14),
        found.limit_event(at)["linkage_torque"] / (0.56 * math.sin(0.75)) * math.hypot(0.56, 0.14) / 0.28,
    )
    least = math.sqrt(1.5 * force * leg**2 * 12 * 10 / (math.pi**2 * 207e9))  # I = A^2/(12 10) of the narrow side
    assert found.values(at)["link_buckling"][1] == pytest.approx(least)


def test_decay_is_not_counted_on_a_tyre_mode(configs):
    """The damping ratio is that of the mode in which the piston yaws, whatever swings more slowly beside it."""
    from damperopt.optimum.damping_exchange import least_damping

    study = Study.model_validate(study_block("arreaza"))
    design = {"c_lambda": 3e4, "I_arm": 8e-7, "L": 0.5, "gamma": 0.6, "b": 0.2, "A_piston": 9e-4, "rod_diameter": 0.012}
    design |= {"s_damper": 0.016, "I_link": 2.1e-6, "I_support": 7.5e-7}
    found = DesignProblem(study)
    least = least_damping(found, design)[0]
    A = found.model.at(design).matrices(least.speed, least.load)[0]
    names = list(found.model.state_names)
    roots, right = np.linalg.eig(A)
    of_yaw = np.abs(right[names.index("yaw_angle")] * np.linalg.inv(right)[:, names.index("yaw_angle")])
    s = max((share, root.real, root.imag) for share, root in zip(of_yaw, roots, strict=True) if root.imag > 0)
    assert least.ratio == pytest.approx(-s[1] / math.hypot(*s[1:]), rel=1e-6)
