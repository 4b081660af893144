"""Filled maps and traced curves beside eigenvalues on grids.

    python benchmarks/charts.py

The plane is damping by second moment of the arm, main gear, fifth order, new design, planar, 40 m/s, 150 kN. Maps: points per
second of the compiled kernels (after compilation), of stacked numpy.linalg.eigvals on given matrices, and of a Python loop.
Curves: evaluations and time of the traced and of the explicit boundary, and what a grid needs whose interpolated contour
is as accurate.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable

import numpy as np

import damperopt
from damperopt.charts.explicit import boundary, joint_of
from damperopt.charts.maps import StabilityMap
from damperopt.charts.plane import Axis, Plane
from damperopt.charts.tracing import trace

STUDY = "configs/thesis_gear.yaml"
X, Y = ("c_lambda", 0.0, 2e5), ("I_arm", 0.0, 1e-5)


def shortest(work: Callable[[], object], repeats: int = 5) -> float:
    best = math.inf
    for _ in range(repeats):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return best


def plane_of(study: damperopt.Study) -> Plane:
    return Plane(study, Axis.of(study, *X), Axis.of(study, *Y), study.start, 40.0, 150e3, margin=0.1)


def maps(study: damperopt.Study) -> None:
    plane = plane_of(study)
    begin = time.perf_counter()
    kernels = StabilityMap(plane)
    few = np.linspace(0, 1, 4)
    for kernel in (kernels.kept, kernels.abscissa, kernels.damping_ratio):
        kernel(2e5 * few, 1e-5 * few)
    print(f"\nCompilation of the three kernels: {time.perf_counter() - begin:.1f} s")
    U, V = (grid.ravel() for grid in np.meshgrid(np.linspace(0, 1, 100), np.linspace(0, 1, 100)))
    matrices = plane.matrices(U, V)
    stacked = len(matrices) / shortest(lambda: np.linalg.eigvals(matrices))
    loop = 1000 / shortest(lambda: [np.linalg.eigvals(A).real.max() for A in matrices[:1000]], 2)
    print("\n| method | points | points/s | over stacked eigvals |\n|---|---|---|---|")
    print(f"| Python loop of eigvals | 1e3 | {loop:.2g} | {loop / stacked:.2g} |")
    print(f"| stacked eigvals | 1e4 | {stacked:.2g} | 1 |")
    for name, kernel in (("sign", kernels.kept), ("abscissa", kernels.abscissa), ("damping ratio", kernels.damping_ratio)):
        for side in (32, 100, 320, 1000, 3163):
            x, y = np.linspace(X[1], X[2], side), np.linspace(Y[1], Y[2], side)
            tiles = np.array_split(y, max(side**2 // 2_000_000, 1))  # a few megabytes at a time
            rate = side**2 / shortest(lambda k=kernel, x=x, t=tiles: [k(x, tile).sum() for tile in t], 3)
            print(f"| {name} | {side**2:.1e} | {rate:.2g} | {rate / stacked:.2g} |")
    x, y = np.linspace(X[1], X[2], 100), np.linspace(Y[1], Y[2], 100)
    values = np.linalg.eigvals(matrices).real.max(axis=1).reshape(100, 100)
    difference = np.abs(kernels.abscissa(x, y) - values).max()
    print(f"\nLargest difference of the abscissa from eigvals on 1e4 points: {difference:.1e} 1/s")


def curves(study: damperopt.Study) -> None:
    reference = densely(explicit(plane_of(study), 1e-9))
    print("\n| curve | tolerance | evaluations | time [ms] | points | largest error | grid of equal accuracy | grid/curve |")
    print("|---|---|---|---|---|---|---|---|")
    for name, curve in (("traced", traced), ("explicit", explicit)):
        for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
            plane = plane_of(study)
            begin = time.perf_counter()
            lines = curve(plane, tolerance)
            elapsed = time.perf_counter() - begin
            found = densely(lines)
            error = max(distance(reference, found), distance(found, reference))
            side = grid_side(study, reference, max(error, 1e-9))
            points = sum(len(line.points) for line in lines)
            print(
                f"| {name} | {tolerance:g} | {plane.evaluations} | {1e3 * elapsed:.0f} | {points} | {error:.1e} | "
                f"{side:.0f}^2 | {side**2 / plane.evaluations:.2g} |"
            )


def traced(plane: Plane, tolerance: float) -> list:
    return trace(plane.excess, tolerance=tolerance)


def explicit(plane: Plane, tolerance: float) -> list:
    found = joint_of(plane)
    assert found is not None
    return boundary(plane, found, tolerance) or []


def densely(lines: list) -> list[np.ndarray]:
    return [line.points for line in lines]


def distance(points: list[np.ndarray], lines: list[np.ndarray]) -> float:
    """Largest distance of points from chains of chords."""
    from scipy.spatial import KDTree

    worst = 0.0
    ends = [(line[:-1], line[1:]) for line in lines]
    a, b = np.vstack([e[0] for e in ends]), np.vstack([e[1] for e in ends])
    tree, reach = KDTree((a + b) / 2), np.linalg.norm(b - a, axis=1).max()
    for line in points:
        for p in line[:: max(len(line) // 2000, 1)]:
            near = tree.query_ball_point(p, reach + 1e-3)
            d, r = b[near] - a[near], p - a[near]
            t = np.clip((r * d).sum(1) / np.maximum((d * d).sum(1), 1e-300), 0, 1)
            worst = max(worst, float(np.linalg.norm(r - t[:, None] * d, axis=1).min()))
    return worst


def grid_side(study: damperopt.Study, reference: list[np.ndarray], error: float) -> float:
    """Side of a grid whose contour is as accurate: measured on two grids, then by its order of convergence."""
    from contourpy import contour_generator

    sides, errors = (100, 400), []
    for side in sides:
        u = np.linspace(0, 1, side + 1)
        plane = plane_of(study)
        z = plane.excess(*np.meshgrid(u, u))
        lines = contour_generator(u, u, z).lines(0.0)
        errors.append(distance(reference, lines))
    order = math.log(errors[0] / errors[1]) / math.log(sides[1] / sides[0])
    return sides[1] * (errors[1] / error) ** (1 / order)


if __name__ == "__main__":
    gear = damperopt.load(STUDY)
    maps(gear)
    curves(gear)
