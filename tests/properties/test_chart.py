"""Charts of gears of all kinds against eigenvalues, closed forms and an explicit curve."""

import json
from types import SimpleNamespace

import numpy as np
import pytest
from basic_twin import parameters, spectral_abscissa, state_matrix
from components_of import damper_block
from random_gears import random_gear, rotational
from tolerances import ON_THE_CURVE

import damperopt
from damperopt.charts.explicit import boundary as joint_lines
from damperopt.charts.explicit import joint_of
from damperopt.charts.plane import Axis, Plane
from damperopt.charts.tracing import trace
from damperopt.errors import ConfigError
from damperopt.stability.linear import LinearModel

PLANES = [
    (("damper.torsional_damping", 0.0, 5e3), ("damper.torsional_stiffness", 0.0, 1e6)),
    (("speed", 1.0, 200.0), ("damper.torsional_damping", 0.0, 2e3)),
    (("caster_length", -0.3, 0.5), ("speed", 1.0, 200.0)),
    (("speed", 1.0, 150.0), ("vertical_load", 1e3, 3e5)),
    (("relaxation_length", 0.05, 1.0), ("caster_length", -0.3, 0.5)),
]


def distance_to(curves, points, low, span):
    """Of each point from the curves, in fractions of the ranges."""
    best = np.full(len(points), np.inf)
    p = (points - low) / span
    for curve in curves:
        q = (curve.points - low) / span
        a, d = q[:-1], np.diff(q, axis=0)
        for i in range(0, len(p), 200):
            r = p[i : i + 200, None] - a
            t = np.clip((r * d).sum(-1) / np.maximum((d * d).sum(-1), 1e-300), 0, 1)
            best[i : i + 200] = np.minimum(best[i : i + 200], np.linalg.norm(r - t[..., None] * d, axis=-1).min(axis=1))
    return best


@pytest.mark.parametrize("seed", [*range(6), *(pytest.param(seed, marks=pytest.mark.verify) for seed in range(6, 12))])
@pytest.mark.parametrize("plane", range(len(PLANES)))
def test_curves_and_sides_are_those_of_the_eigenvalues(main_gear, seed, plane):
    """On the curve the abscissa is minus the margin; 1500 random points off it by the stated size are on the side it says."""
    rng = np.random.default_rng(100 * plane + seed)
    study = random_gear(rng, main_gear)
    x, y = PLANES[plane]
    margin = float(rng.choice([0.0, 0.1, 1.0]))
    found = damperopt.chart(study, x, y, margin=margin, cells=40)
    family = found.families[0]
    reference = Plane(study, Axis.of(study, *x), Axis.of(study, *y), {}, found.speed, found.load)
    low, span = np.array([x[1], y[1]]), np.array([x[2] - x[1], y[2] - y[1]])

    def abscissa(points):
        u, v = ((points - low) / span).T
        return np.linalg.eigvals(reference.matrices(u, v)).real.max(axis=1)

    for curve in family.curves:
        scale = np.abs(reference.matrices(*((curve.points - low) / span).T)).max()
        assert np.abs(abscissa(curve.points) + margin).max() < ON_THE_CURVE * scale
    points = low + span * rng.random((1500, 2))
    wrong = (abscissa(points) < -margin) != found.stable(*points.T)
    # strips narrower than half a fine cell may be cut where they end: the stated size
    assert (distance_to(family.curves, points[wrong], low, span) < found.cell / 4).all()
    assert wrong.mean() < 0.003


def test_third_order_gear_lies_on_the_closed_form(main_gear):
    """c_psi of the theory page's quadratic, at every point of the Hopf curve in (stiffness, damping)."""
    study = rotational(main_gear, order=3)
    found = damperopt.chart(
        study, ("damper.torsional_stiffness", 0.0, 1e6), ("damper.torsional_damping", 0.0, 2e3), speed=40.0, load=150e3
    )
    V, F, s, a, e, I = 40.0, 150e3, 0.3, 0.1, 0.12, 100.0
    M_a = (e * 0.014 + 1.0) * F
    (curve,) = found.families[0].curves
    for k, c in curve.points[curve.hopf][1:-1:20]:
        D = c + 570.0 / V
        residue = D**2 * s / V + D * (I + s * (k * s + M_a * (e - a)) / V**2) + I / V * M_a * (e - a - s)
        assert abs(residue) < 1e-6 * abs(I / V * M_a * (e - a - s))


JOINTS = [
    ({"topology": "rotational", "torsional_stiffness": 0.0, "torsional_damping": 0.0}, "damper.torsional_damping", 3e3,
     "damper.torsional_stiffness", 3e6),
    (damper_block("boeing"), "c_lambda", 3e4, "k_lambda", 1e7),
    (damper_block("utas", geometry="spatial"), "c_lambda", 1.2e5, "I_arm", 1e-5),
    (damper_block("arreaza", geometry="spatial"), "c_lambda", 4e4, "I_arm", 1e-5),
    (damper_block("boeing", series_stiffness=3e7), "gear.lateral.damping", 1e4, "gear.lateral.stiffness", 2e7),
]  # fmt: skip


@pytest.mark.parametrize("margin", [pytest.param(0.0, marks=pytest.mark.slow), 0.2])
@pytest.mark.parametrize("speed", [12.0, 40.0, 90.0])
@pytest.mark.parametrize("joint", JOINTS, ids=["rotational", "boeing", "utas in space", "new in space", "strut, six states"])
def test_quantities_at_one_joint_have_explicit_curves_which_are_the_traced_ones(main_gear, joint, speed, margin):
    """Either way alone finds the same curves; points a little to their sides are on the sides that eigenvalues say."""
    damper, x, high_x, y, high_y = joint
    study = main_gear.replace(damper=damper)
    axes = Axis.of(study, x, 0.0, high_x), Axis.of(study, y, 0.0, high_y)
    plane = Plane(study, *axes, study.start, speed, 150e3, margin)
    explicit = joint_lines(plane, joint_of(plane), 1e-5)
    counted = plane.evaluations
    traced = trace(plane.excess, tolerance=1e-5)
    by_tracing = plane.evaluations - counted
    ours, theirs = (np.vstack([line.points for line in lines]) if lines else np.zeros((0, 2)) for lines in (explicit, traced))
    assert len(ours) or not len(theirs)
    if not len(ours):
        return
    assert counted < by_tracing / 5
    lines = [SimpleNamespace(points=line.points) for line in explicit]
    assert distance_to(lines, theirs, np.zeros(2), np.ones(2)).max() < 5e-5
    assert np.abs(plane.excess(*ours.T)).max() < ON_THE_CURVE * np.abs(plane.matrices(*ours.T)).max()
    for line in explicit:
        run = np.diff(line.points, axis=0)
        long = np.linalg.norm(run, axis=1) > 1e-3
        normal = np.column_stack([-run[long, 1], run[long, 0]]) / np.linalg.norm(run[long], axis=1)[:, None]
        middle = (line.points[:-1] + line.points[1:])[long] / 2
        sides = [plane.excess(*(middle + sign * 1e-4 * normal).T) for sign in (-1, 1)]
        assert (np.sign(sides[0]) != np.sign(sides[1])).mean() > 0.97  # but at corners and where a second curve is that near


def test_chart_says_whether_its_curves_are_explicit(main_gear):
    assert damperopt.chart(main_gear, ("c_lambda", 0.0, 2e5), ("I_arm", 0.0, 1e-5)).families[0].explicit
    assert not damperopt.chart(main_gear, ("c_lambda", 0.0, 2e5), ("speed", 1.0, 100.0)).families[0].explicit


def test_explicit_curves_that_are_wrong_are_traced_instead(main_gear, monkeypatch):
    """A curve too few does not pass for a chart."""
    import sys

    x, y = ("c_lambda", 0.0, 3e4), ("I_arm", 0.0, 1e-5)
    right = damperopt.chart(main_gear, x, y)
    monkeypatch.setattr(sys.modules["damperopt.charts.chart"], "joint_lines", lambda *given: [])
    found = damperopt.chart(main_gear, x, y)
    assert not found.families[0].explicit
    rng = np.random.default_rng(3)
    points = 3e4 * rng.random(500), 1e-5 * rng.random(500)
    assert (found.stable(*points) == right.stable(*points)).all()


def test_joint_boundary_has_the_eigenvalue_that_it_promises(main_gear):
    frequency = np.array([8.0, 12.0, 20.0, 40.0])
    k, c = damperopt.joint_boundary(main_gear, 60.0, 150e3, frequency, margin=0.3)
    for f, k_psi, c_psi in zip(frequency, k, c, strict=True):
        roots = np.linalg.eigvals(state_matrix(60.0, 150e3, parameters(k_psi=k_psi, c_psi=c_psi)))
        assert np.abs(roots - (-0.3 + 2j * np.pi * f)).min() < 1e-8 * np.abs(roots).max()


def test_divergence_and_hopf_meet_in_a_corner(main_gear):
    """A tyre that turns on, far behind the axis: k + M_a = 0 exactly, with a corner to the Hopf curve."""
    tyre = {"aligning_coefficient": -1.4, "tread_width_moment": 0.0}
    study = rotational(main_gear, order=3, caster_length=0.5, tyre=tyre)
    found = damperopt.chart(
        study, ("damper.torsional_stiffness", 0.0, 1e6), ("damper.torsional_damping", 0.0, 2e4), speed=40.0, load=150e3
    )
    M_a = (0.5 * 0.014 - 1.4) * 150e3
    straight = np.vstack([curve.points[~curve.hopf] for curve in found.families[0].curves])
    assert len(straight) >= 2
    assert straight[:, 0] == pytest.approx(np.full(len(straight), -M_a), rel=1e-9)
    corners = np.vstack([curve.corners for curve in found.families[0].curves])
    assert len(corners) == 1
    assert corners[0, 0] == pytest.approx(-M_a, rel=1e-4)


def test_families_and_design(main_gear):
    """Larger speeds need less damping at high stiffness (thesis, chapter 3); the design's abscissa is that of the twin."""
    design = {"c_lambda": 2e4, "I_arm": 1e-6, "L": 0.6, "gamma": 0.541, "b": 0.2}
    found = damperopt.chart(
        main_gear, ("c_lambda", 0.0, 4e4), ("I_arm", 1e-7, 1e-5), vary=("speed", [40.0, 80.0, 160.0]), design=design
    )
    assert [family.value for family in found.families] == [40.0, 80.0, 160.0]
    assert found.mark == (2e4, 1e-6)
    gear = damperopt.linear_gear(main_gear, design)
    for family in found.families:
        assert family.abscissa == pytest.approx(spectral_abscissa(gear.matrices(family.value, 150e3)[0]), abs=1e-9)


@pytest.mark.parametrize("geometry", ["published", "planar", "spatial"])
@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_every_layout_and_geometry_has_a_chart(main_gear, topology, geometry):
    study = main_gear.replace(damper=damper_block(topology, geometry=geometry))
    found = damperopt.chart(study, ("c_lambda", 0.0, 2e5), ("L", 0.3, 1.2), speed=40.0)
    rng = np.random.default_rng(1)
    x, y = 2e5 * rng.random(300), 0.3 + 0.9 * rng.random(300)
    model = LinearModel(study)
    gears = [model.at({**study.start, "c_lambda": c, "L": length}) for c, length in zip(x, y, strict=True)]
    expected = np.array([gear.abscissa(40.0, 150e3)[0] < 0 for gear in gears])
    assert (found.stable(x, y) == expected).mean() > 0.99


@pytest.mark.parametrize(
    ("x", "message"),
    [
        (("c_lambda", 2.0, 1.0), "low < high"),
        (("c_lambda", -1.0, 1.0), ">= 0"),
        (("speed", 0.0, 1.0), "> 0"),
        (("colour", 0.0, 1.0), "unknown"),
        (("I_arm", 0.0, 1e-5), "both axes"),
        (("damping", 0.0, 1.0), "gear.lateral.damping|unknown"),
        (("c_lambda", 0.0, np.inf), "finite"),
        (("yaw_inertia", -10.0, 10.0), "yaw_inertia"),
        (("material.youngs_modulus", 0.0, 2e11), "youngs_modulus"),
    ],
)
def test_bad_questions_are_refused(main_gear, x, message):
    if x[0] == "damping":
        assert damperopt.chart(main_gear, ("damping", 1.0, 1e3), ("I_arm", 0.0, 1e-5)).x.name == "gear.lateral.damping"
        return
    with pytest.raises(ConfigError, match=message):
        damperopt.chart(main_gear, x, ("I_arm", 0.0, 1e-5))


def test_files_of_a_chart(main_gear, tmp_path):
    from damperopt.output.gallery import write_chart_files

    found = damperopt.chart(main_gear, ("c_lambda", 0.0, 2e5), ("I_arm", 0.0, 1e-5), vary=("speed", [40.0, 80.0]))
    write_chart_files(tmp_path, found)
    assert {f.name for f in tmp_path.iterdir()} == {"chart.csv", "chart.json", "chart.png", "chart.svg"}
    data = json.loads((tmp_path / "chart.json").read_text())
    lines = (tmp_path / "chart.csv").read_text().splitlines()
    assert lines[0] == "speed [m/s],curve,c_lambda [N s/m],I_arm [m^4],type,frequency [Hz]"
    assert len(lines) - 1 == sum(len(c["points"]) for f in data["families"] for c in f["curves"])


def test_two_modes_meet_in_a_corner_of_the_nose_gear(configs):
    """Torsional and lateral shimmy over (speed, load), Thota et al.: one corner, 10 and 16 Hz on its sides."""
    study = damperopt.load(configs / "nose_gear_thota.yaml")
    found = damperopt.chart(study, ("speed", 1.0, 200.0), ("vertical_load", 1e3, 3e5))
    corners = np.vstack([curve.corners for curve in found.families[0].curves])
    assert len(corners) == 1
    roots = np.linalg.eigvals(damperopt.linear_gear(study).matrices(*corners[0])[0])
    rightmost = np.sort(roots[roots.imag > 0].real)
    assert np.abs(rightmost).max() < 1e-2  # both on the axis
