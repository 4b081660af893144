"""Feasible region of a study in the plane of two design variables, the others at the optimum; for drawing."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from ..stability.screening import SPEEDS, worst_abscissae_of
from ..study.study import Study
from .problem import ESTIMATED, DesignProblem

__all__ = ["FeasibleRegion", "feasible_region"]

COARSE = 4
"""Nodes in a cell of the grid on which stability is looked at first, where that takes eigenvalues."""

PER_CYCLE = 64
"""Times in a cycle of the slowest mode: a yaw mode of four times its frequency is still a curve."""


@dataclass(frozen=True)
class FeasibleRegion:
    """Maps over a plane of two design variables.

    Attributes
    ----------
    x_name, y_name : str
        Design variables of the axes.
    x, y : ndarray
        (m,), (k,) their values [SI].
    mass : ndarray
        (k, m) [kg].
    stability : ndarray
        (k, m) over the speeds and loads looked at > 0 where the margin holds: beside its limit how far the spectral abscissa is
        from it [1/s], elsewhere the least stability condition, scaled, or what lies between coarser nodes.
    violated : dict of str to ndarray
        Strength and geometry rows by name, (k, m), > 0 where the constraint is violated.
    design : dict
        The design that the plane passes through.
    """

    x_name: str
    y_name: str
    x: np.ndarray
    y: np.ndarray
    mass: np.ndarray
    stability: np.ndarray
    violated: dict[str, np.ndarray]
    design: dict[str, float]

    @property
    def feasible(self) -> np.ndarray:
        """(k, m) bool: stable and no constraint violated."""
        return (self.stability > 0) & ~np.any([row > 1e-9 for row in self.violated.values()], axis=0)


def feasible_region(
    study: Study,
    design: Mapping[str, float],
    worst: Sequence[tuple[float, float]] = (),
    points: int = 101,
    limit_event: Mapping[str, float] | None = None,
) -> FeasibleRegion:
    """Feasible region in the plane of damping and stiffness: (c_lambda, I_arm), or (c_lambda, k_lambda) for Boeing.

    Parameters
    ----------
    study : Study
    design : mapping
        Design in the plane [SI]; the axes reach a factor of 10 to each side of it.
    worst : list of (speed, load)
        Points of the envelope to look at besides 24 speeds at each load.
    points : int
        Grid points per axis.
    limit_event : mapping or None
        Peaks of the limit event of the design, as a result holds them; their ratio to the estimate is taken for the same all
        over the plane. None: as estimated.

    Returns
    -------
    FeasibleRegion
        A picture, not a proof: stability is looked at on a few speeds, decay by the linear gear and of rigid chains alone;
        uncertain damping at both ends of its interval.
    """
    problem = DesignProblem(study)
    names = problem.design_names
    x_name, y_name = names[0], names[1]
    x, y = (design[name] * np.geomspace(0.1, 10, points) for name in (x_name, y_name))
    X, Y = np.meshgrid(x, y)
    designs = np.tile([design[name] for name in names], (X.size, 1))
    designs[:, 0], designs[:, 1] = X.ravel(), Y.ravel()
    factors = ESTIMATED
    if limit_event and study.required.limit_event == "simulated":
        factors = problem.factors_of(design, limit_event)
    found = problem.over_designs(designs, factors)
    k_psi, c_psi = found["torsional_stiffness"], found["torsional_damping"]
    factors_on_c = dict.fromkeys(study.damper.damping_factors())
    stability = np.min([_stability(problem, designs, (k_psi, c * c_psi), c, worst, X.shape) for c in factors_on_c], axis=0)
    rows = {name: found["rows"][:, i].reshape(X.shape) for i, name in enumerate(problem.constraint_names)}
    decay = study.required.decay
    if decay is not None and problem.plain:
        ratio = np.full(X.size, np.inf)
        kept = stability > 0
        ratio[kept] = np.max(
            [problem.screening.linear_decay(k_psi[kept], c * c_psi[kept], PER_CYCLE) for c in factors_on_c], axis=0
        )
        rows["decay_ratio"] = np.log(np.maximum(ratio, 1e-12) / decay.ratio).reshape(X.shape)
    return FeasibleRegion(x_name, y_name, x, y, found["mass"].reshape(X.shape), stability.reshape(X.shape), rows, dict(design))


def _stability(
    problem: DesignProblem,
    designs: np.ndarray,
    yaw: tuple[np.ndarray, np.ndarray],
    factor: float,
    worst: Sequence[tuple[float, float]],
    shape: tuple[int, ...],
) -> np.ndarray:
    """`FeasibleRegion.stability` with a factor on the damping, which the stiffness and damping `yaw` have already."""
    study = problem.study
    if problem.plain and problem.search_model is problem.model:
        stability: np.ndarray = problem.screening.least_conditions(*yaw, worst)
        near = _beside_the_limit(stability.reshape(shape)).ravel()
        abscissae = problem.screening.worst_abscissae(yaw[0][near], yaw[1][near], worst, SPEEDS)
        stability[near] = -study.required.stability_margin - abscissae  # even enough for a curve between the nodes
        return stability
    scaled = designs.copy()
    scaled[:, [name == study.damper.VISCOUS for name in problem.design_names]] *= factor

    def kept(which: np.ndarray) -> np.ndarray:
        return -study.required.stability_margin - worst_abscissae_of(problem.model, study, scaled[which.ravel()], worst)

    return _near_zero(kept, shape).ravel()


def _near_zero(function: Callable[[np.ndarray], np.ndarray], shape: tuple[int, ...]) -> np.ndarray:
    """Values on a grid: at its nodes in the cells of a coarser one through which zero passes, elsewhere between its corners.

    `function` has the values at the nodes of a mask, in order.
    """
    rows, columns = (np.unique(np.append(np.arange(0, size, COARSE), size - 1)) for size in shape)
    known = np.zeros(shape, bool)
    known[np.ix_(rows, columns)] = True
    corners = function(known).reshape(rows.size, columns.size)
    nodes = np.moveaxis(np.indices(shape), 0, -1)
    values: np.ndarray = RegularGridInterpolator((rows, columns), corners)(nodes)
    while True:
        wanted = np.zeros(shape, bool)
        for i, j in itertools.product(range(rows.size - 1), range(columns.size - 1)):
            cell = slice(rows[i], rows[i + 1] + 1), slice(columns[j], columns[j + 1] + 1)
            kept = values[cell] > 0
            wanted[cell] |= kept.any() and not kept.all()
        wanted &= ~known
        if not wanted.any():
            return values
        values[wanted], known = function(wanted), known | wanted


def _beside_the_limit(values: np.ndarray) -> np.ndarray:
    """Corners (k, m) of the cells in which values change their sign."""
    kept = values > 0
    corners = [kept[:-1, :-1], kept[:-1, 1:], kept[1:, :-1], kept[1:, 1:]]
    mixed = np.any(corners, axis=0) & ~np.all(corners, axis=0)
    beside = np.zeros(values.shape, bool)
    for rows in (slice(None, -1), slice(1, None)):
        for columns in (slice(None, -1), slice(1, None)):
            beside[rows, columns] |= mixed
    return beside
