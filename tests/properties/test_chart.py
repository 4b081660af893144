"""Charts of gears of all kinds against eigenvalues, closed forms and an explicit curve."""

import json

import numpy as np
import pytest
from basic_twin import parameters, spectral_abscissa, state_matrix
from random_gears import random_gear, rotational
from tolerances import ON_THE_CURVE

import damperopt
from damperopt.errors import ConfigError
from damperopt.plane import Axis, Plane

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


@pytest.mark.parametrize("seed", range(12))
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


@pytest.mark.parametrize("margin", [0.0, 0.2])
@pytest.mark.parametrize("geometry", ["planar", "spatial"])
def test_explicit_curve_of_the_joint_is_the_traced_one(main_gear, margin, geometry):
    """k + s c = -1/G(s): the traced Hopf points have the stiffness and damping that their own frequency gives."""
    study = rotational(main_gear)
    found = damperopt.chart(
        study,
        ("damper.torsional_stiffness", 1e4, 3e6),
        ("damper.torsional_damping", 0.0, 3e3),
        speed=40.0,
        load=150e3,
        margin=margin,
    )
    compared = 0
    for curve in found.families[0].curves:
        points, frequency = curve.points[curve.hopf], curve.frequency[curve.hopf]
        k, c = damperopt.joint_boundary(main_gear.replace(damper__geometry=geometry), 40.0, 150e3, frequency, margin)
        # the lateral mode's frequency hardly depends on k: its rounding is that of k, magnified
        away = np.abs(frequency - 16.05) > 0.05
        assert np.abs(k - points[:, 0])[away].max() < 1e-4 * 3e6
        assert np.abs(c - points[:, 1])[away].max() < 1e-4 * 3e3
        compared += away.sum()
    assert compared > 50


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
    assert len(straight) > 2
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
    study = main_gear.replace(damper={"topology": topology, "geometry": geometry})
    found = damperopt.chart(study, ("c_lambda", 0.0, 2e5), ("L", 0.3, 1.2), speed=40.0)
    rng = np.random.default_rng(1)
    x, y = 2e5 * rng.random(300), 0.3 + 0.9 * rng.random(300)
    gears = [damperopt.linear_gear(study, {**study.start, "c_lambda": c, "L": length}) for c, length in zip(x, y, strict=True)]
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
    ],
)
def test_bad_questions_are_refused(main_gear, x, message):
    if x[0] == "damping":
        assert damperopt.chart(main_gear, ("damping", 1.0, 1e3), ("I_arm", 0.0, 1e-5)).x.name == "gear.lateral.damping"
        return
    with pytest.raises(ConfigError, match=message):
        damperopt.chart(main_gear, x, ("I_arm", 0.0, 1e-5))


def test_files_of_a_chart(main_gear, tmp_path):
    from damperopt.run_files import write_chart_files

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
