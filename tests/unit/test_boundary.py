"""Tracing of boundaries whose shape is known: circles, islands smaller than a cell, corners, crossings."""

import numpy as np
import pytest
from tolerances import ROUNDING

from damperopt.charts.tracing import trace


def circle(x, y, r):
    return lambda u, v: np.hypot(u - x, v - y) - r


def union(*parts):
    return lambda u, v: np.min([part(u, v) for part in parts], axis=0)


class Counted:
    def __init__(self, excess):
        self.excess, self.count = excess, 0

    def __call__(self, u, v):
        self.count += np.size(u)
        return self.excess(u, v)


def test_circle_is_one_closed_curve_within_the_tolerance():
    (line,) = trace(circle(0.47, 0.52, 0.31), tolerance=1e-6)
    radii = np.hypot(line.points[:, 0] - 0.47, line.points[:, 1] - 0.52)
    middles = (line.points[1:] + line.points[:-1]) / 2
    assert line.closed
    assert np.abs(radii - 0.31).max() < 1e-12
    assert (0.31 - np.hypot(middles[:, 0] - 0.47, middles[:, 1] - 0.52)).max() < 2e-6
    length = np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum()
    assert length == pytest.approx(2 * np.pi * 0.31, rel=1e-5)


@pytest.mark.parametrize("radius", [0.2, 0.03, 0.004, 0.0005])
def test_islands_are_found_beside_another_branch(radius):
    """Cells are 0.021 wide: the smaller ones lie inside one, and are found from the local extremum of the grid."""
    lines = trace(union(circle(0.637, 0.641, radius), circle(0.1, 0.1, 0.05)))
    assert len(lines) == 2
    assert all(line.closed for line in lines)
    sizes = sorted(np.ptp(line.points[:, 0]) for line in lines)
    assert sizes == pytest.approx(sorted([0.1, 2 * radius]), rel=0.01)


def test_hole_in_a_stable_plane_is_found():
    (line,) = trace(lambda u, v: -circle(0.513, 0.777, 0.002)(u, v))
    assert np.ptp(line.points[:, 1]) == pytest.approx(0.004, rel=0.01)


def test_corner_is_met_to_the_tolerance():
    """A kink at (0.6, 0.4): the curve passes within the tolerance of it."""
    (line,) = trace(lambda u, v: v - 0.4 - np.where(u > 0.6, 0.3 * (u - 0.6), 2 * (0.6 - u)), tolerance=1e-6)
    assert np.hypot(line.points[:, 0] - 0.6, line.points[:, 1] - 0.4).min() < 3e-6


def test_curve_that_leaves_a_cell_twice_is_followed():
    """A needle of width 0.006 through cells of 0.021: coarse signs show its root only."""
    lines = trace(lambda u, v: np.abs(v - 0.51) - np.where(u < 0.2, 0.1, 0.1 * np.exp(-20 * (u - 0.2)) + 0.003) + 0 * u)
    assert len(lines) == 2  # above and below
    assert all(np.ptp(line.points[:, 0]) == 1.0 for line in lines)


@pytest.mark.parametrize("value", [-1.0, 1.0])
def test_plane_of_one_sign_has_no_boundary(value):
    assert trace(lambda u, v: value + 0 * u * v) == []


def test_crossing_branches_do_not_break_the_search():
    """u v = 0 about the middle: four arms; all points lie on one of the two lines."""
    lines = trace(lambda u, v: (u - 0.503) * (v - 0.497))
    points = np.vstack([line.points for line in lines])
    assert np.abs((points[:, 0] - 0.503) * (points[:, 1] - 0.497)).max() < ROUNDING
    assert sum(np.linalg.norm(np.diff(line.points, axis=0), axis=1).sum() for line in lines) == pytest.approx(2, rel=0.01)


def test_cost_grows_with_the_length_and_slowly_with_the_tolerance():
    """Twice the length: at most twice the work beyond the coarse grid; a hundredth of the tolerance: ten times the points."""

    def beyond_the_grid(radius, tolerance):
        counted = Counted(circle(0.5, 0.5, radius))
        trace(counted, tolerance=tolerance)
        return counted.count - 49**2

    assert beyond_the_grid(0.4, 1e-5) < 2.3 * beyond_the_grid(0.2, 1e-5)
    assert beyond_the_grid(0.4, 1e-8) < 15 * beyond_the_grid(0.4, 1e-6)


@pytest.mark.parametrize("angle", [40.0, 80.0, 140.0])
def test_tip_of_a_wedge_is_met_to_the_tolerance(angle):
    """A wedge with its tip at (0.31, 0.64); sharper ones may lose part of a fine cell, as the theory page says."""
    slope = np.tan(np.deg2rad(angle / 2))
    lines = trace(lambda u, v: np.abs(v - 0.64) - slope * (u - 0.31), tolerance=1e-6)
    points = np.vstack([line.points for line in lines])
    assert np.hypot(points[:, 0] - 0.31, points[:, 1] - 0.64).min() < 1e-5 / slope
