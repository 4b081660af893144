"""Compiled maps of gears of all kinds against numpy.linalg.eigvals."""

import numpy as np
import pytest
from random_gears import random_gear, rotational

import damperopt
from damperopt.charts.maps import StabilityMap
from damperopt.charts.plane import Axis, Plane

PLANES = [
    (("damper.torsional_damping", 0.0, 5e3), ("damper.torsional_stiffness", 0.0, 1e6)),
    (("speed", 1.0, 200.0), ("caster_length", -0.3, 0.5)),
    (("speed", 1.0, 150.0), ("vertical_load", 1e3, 3e5)),
    (("relaxation_length", 0.05, 1.0), ("rake_angle", -0.3, 0.3)),
]


def compared(study, design, x, y, margin, load=150e3):
    """Maps, and eigenvalues, on the same 61 x 47 points."""
    plane = Plane(study, Axis.of(study, *x), Axis.of(study, *y), design, 40.0, load, margin)
    found, X, Y = StabilityMap(plane), np.linspace(x[1], x[2], 61), np.linspace(y[1], y[2], 47)
    U, W = np.meshgrid(np.linspace(0, 1, 61), np.linspace(0, 1, 47))
    roots = np.linalg.eigvals(plane.matrices(U.ravel(), W.ravel()))
    worst = roots.real.max(axis=1).reshape(U.shape)
    scale = np.abs(roots).max(axis=1).reshape(U.shape)
    damping = (-roots.real / np.maximum(np.abs(roots), 1e-300)).min(axis=1).reshape(U.shape)
    return found, X, Y, worst, scale, damping


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.verify) for seed in (1, 2, 3))])
@pytest.mark.parametrize("plane", range(len(PLANES)))
def test_maps_of_random_gears(main_gear, seed, plane):
    """Values to 1e-7 of the largest root (two equal roots have half the digits), sides wherever they are clear."""
    rng = np.random.default_rng(50 * plane + seed)
    study, margin = random_gear(rng, main_gear), float(rng.choice([0.0, 0.3]))
    found, X, Y, worst, scale, damping = compared(study, {}, *PLANES[plane], margin, study.envelope.loads[0])
    assert np.abs(found.abscissa(X, Y) - worst).max() < 1e-7 * scale.max()
    clear = np.abs(worst + margin) > 1e-9 * scale
    assert (found.kept(X, Y) == (worst < -margin))[clear].all()
    single = np.abs(worst) > 1e-6 * scale  # a root at zero has no damping ratio
    assert np.abs(found.damping_ratio(X, Y) - damping)[single].max() < 1e-6


@pytest.mark.slow
@pytest.mark.parametrize("geometry", [pytest.param("published", marks=pytest.mark.verify), "planar", "spatial"])
def test_maps_of_every_geometry(main_gear, geometry):
    study = main_gear.replace(damper__topology="utas", damper__geometry=geometry)
    found, X, Y, worst, scale, _ = compared(study, study.start, ("c_lambda", 0.0, 2e5), ("L", 0.3, 1.2), 0.1)
    assert np.abs(found.abscissa(X, Y) - worst).max() < 1e-7 * scale.max()
    clear = np.abs(worst + 0.1) > 1e-9 * scale
    assert (found.kept(X, Y) == (worst < -0.1))[clear].all()


@pytest.mark.slow
@pytest.mark.parametrize("law", ["tr_r64", pytest.param("magic_formula", marks=pytest.mark.verify)])
def test_maps_of_tyres_that_change_with_the_load(configs, law):
    """Their graphs hold comparisons, roots, sines and arctangents of the load."""
    name = {"tr_r64": "nose_gear_tr_r64", "magic_formula": "main_gear_property_file"}[law]
    study = damperopt.load(configs / f"{name}.yaml")
    low, high = study.envelope.loads[0], study.envelope.loads[-1]
    damped = study.start or {}
    found, X, Y, worst, scale, damping = compared(study, damped, ("speed", 2.0, 90.0), ("vertical_load", low, high), 0.0)
    assert np.abs(found.abscissa(X, Y) - worst).max() < 1e-7 * scale.max()
    assert np.abs(found.damping_ratio(X, Y) - damping).max() < 1e-6


@pytest.mark.slow
def test_map_and_traced_boundary_agree(main_gear):
    """Sixth order, with a compliant damper: pixels on either side of the traced curve."""
    study = main_gear.replace(damper__series_stiffness=3e7)
    x, y = ("c_lambda", 500.0, 2e5), ("I_arm", 1e-7, 1e-5)
    chart = damperopt.chart(study, x, y, speed=40.0, load=150e3)
    plane = Plane(study, Axis.of(study, *x), Axis.of(study, *y), study.start, 40.0, 150e3)
    X, Y = np.linspace(x[1], x[2], 300), np.linspace(y[1], y[2], 300)
    assert (StabilityMap(plane).kept(X, Y) == chart.stable(*np.meshgrid(X, Y))).mean() > 0.9999


def test_a_pixel_whose_iteration_does_not_converge_is_found_by_eigenvalues(main_gear, monkeypatch):
    x, y = ("damper.torsional_damping", 0.0, 5e3), ("damper.torsional_stiffness", 0.0, 1e6)
    study = rotational(main_gear)
    found, X, Y, worst, scale, damping = compared(study, {}, x, y, 0.0)
    for name in ("_abscissa", "_damping"):
        monkeypatch.setattr(found, name, lambda x, y, out: out.fill(np.nan))
    assert np.abs(found.abscissa(X, Y) - worst).max() < 1e-12 * scale.max()
    assert np.abs(found.damping_ratio(X, Y) - damping).max() < 1e-12
