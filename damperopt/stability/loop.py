"""A gear opened at its tyres or at its damper: what comes back round the loop, L(s).

With L = 0 the loop is open, and its characteristic function is that of the gear there divided by det(1 + L). A factor f on what
is cut makes that det(1 + f L), so that margins of gain, phase and disk are margins of one common factor on the forces and
moments of all tyres, or on the damping.

Tyres: u = (F_y, M_z) of each wheel are cut, L = -T(s) G(s) with the structure's G (`response`). In matrices: with the rows of
the structure without its tyres, A_open, and its columns B, s - A(s) = (s - A_open)(1 - (s - A_open)^-1 B K(s)).
Damper: det(s - A) f^m is affine in the factor f on the damping, R_0 + f R_1, with m massless nodes beside it; L = R_1/R_0.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from ..errors import ConfigError
from ..study.study import Study
from .delay import LENGTH, DelayGear
from .gear import LinearGear
from .linear import LinearModel
from .response import Structure

__all__ = ["BREAKS", "Loop", "opened"]

Break = Literal["tyre", "damper"]
BREAKS: tuple[Break, ...] = ("tyre", "damper")

FAINT = 1e-9
"""Factor on a design variable, which is above 0, at which the loop counts as open."""

AFFINE = 1e-6
"""What affine functions of the factor may differ by, relative: sums of determinants."""

MOST_NODES = 4
"""Massless nodes beside a damper that are tried."""


@dataclass(frozen=True)
class Loop:
    """The loop at one speed and load.

    Attributes
    ----------
    speed, load : float
        [m/s], [N]
    response : callable
        s (k,) [1/s] -> L (k, r, r), as it comes back with its sign: 1 + L is the return difference.
    open_poles, closed_poles : ndarray
        Eigenvalues [1/s] with the loop open and closed; the rightmost ones where there is a delay.
    degree : int
        Power of s with which det(1 + L) grows.
    delay: float
        Of the longest contact line [s]; 0: none.
    """

    speed: float
    load: float
    response: Callable[[np.ndarray], np.ndarray]
    open_poles: np.ndarray
    closed_poles: np.ndarray
    degree: int = 0
    delay: float = 0.0


def opened(study: Study, design: Mapping[str, float], where: Break) -> Callable[[float, float], Loop]:
    """Loop of a study with a design, opened somewhere.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    where : {'tyre', 'damper'}

    Returns
    -------
    callable
        (speed [m/s], load [N]) -> Loop.

    Raises
    ------
    ConfigError
        If there is nothing to open: a tyre without force, a damper without a damping that is one number.
    """
    return _at_tyre(study, design) if where == "tyre" else _at_damper(study, design)


def _matrix(gear: LinearGear, V: float, F_z: float) -> Callable[[np.ndarray], np.ndarray]:
    """A(s) of a gear, s (k,) -> (k, n, n), with the exact delay where it has one."""
    if isinstance(gear, DelayGear):
        frozen = gear.frozen(np.array([V]), np.array([F_z]))
        return lambda s: frozen.at(s[None])[0][0]
    A = gear.matrices(V, F_z)[0]
    return lambda s: np.broadcast_to(A, (len(s), *A.shape))


def _delay(gear: LinearGear, V: float, F_z: float) -> float:
    if not isinstance(gear, DelayGear):
        return 0.0
    return float(gear.frozen(np.array([V]), np.array([F_z])).numbers[:, :, LENGTH].max() / V)


def _at_tyre(study: Study, design: Mapping[str, float]) -> Callable[[float, float], Loop]:
    model = LinearModel(study)
    structure = model.structure or Structure(study)
    if not structure.wheels:
        raise ConfigError(f"--break: found 'tyre', but gear.kind '{study.gear.kind}' has no tyre force; allowed: damper")
    gear = model.at(design)
    names = [state.name for state in gear.principal]
    own = [names.index(state.name) for state in structure.states]
    values = [design[name] for name in structure.design_names]

    def at(V: float, F_z: float) -> Loop:
        blocks = structure.at(values, np.array([V]), np.array([F_z]))
        A, n = _matrix(gear, V, F_z), len(names)
        B = np.zeros((n, blocks.B.shape[2]))
        B[own] = blocks.B[0]
        A_open = A(np.zeros(1, complex))[0].real.copy()
        A_open[own] = 0
        A_open[np.ix_(own, own)] = blocks.A[0]
        # forces and moments of the states, K of B K = A - A_open
        left = np.linalg.pinv(B / np.abs(B).max(axis=0, initial=1e-300)) / np.abs(B).max(axis=0, initial=1e-300)[:, None]

        def response(s: np.ndarray) -> np.ndarray:
            forces = left @ (A(s) - A_open)
            moved = np.linalg.solve(s[:, None, None] * np.eye(n) - A_open, B.astype(complex))
            return np.asarray(-forces @ moved)

        return Loop(
            V, F_z, response, np.linalg.eigvals(A_open).astype(complex), gear.roots(V, F_z)[0], delay=_delay(gear, V, F_z)
        )

    return at


def _at_damper(study: Study, design: Mapping[str, float]) -> Callable[[float, float], Loop]:
    gears = {f: _damped(study, design, f) for f in (0.0, 0.5, 1.0, 2.0)}

    def at(V: float, F_z: float) -> Loop:
        A = {f: _matrix(gears[f], V, F_z) for f in (0.5, 1.0, 2.0)}

        def polynomial(s: np.ndarray, f: float) -> np.ndarray:
            at_s = A[f](s)
            return np.linalg.det(s[:, None, None] * np.eye(at_s.shape[1]) - at_s)

        nodes = _nodes(polynomial, gears[1.0].roots(V, F_z)[0])

        def response(s: np.ndarray) -> np.ndarray:
            whole = polynomial(s, 1.0)
            without = 2 * 0.5**nodes * polynomial(s, 0.5) - whole
            return np.asarray(whole / without - 1)[:, None, None]

        return Loop(
            V, F_z, response, gears[0.0].roots(V, F_z)[0], gears[1.0].roots(V, F_z)[0], nodes, _delay(gears[1.0], V, F_z)
        )

    return at


def _nodes(polynomial: Callable[[np.ndarray, float], np.ndarray], poles: np.ndarray) -> int:
    """How many massless nodes make the determinant affine in the factor on the damping."""
    size = np.abs(poles).max()
    s = size * np.array([0.1 + 0.3j, 0.02 + 0.05j, 0.3 + 0.9j])
    half, whole, twice = (polynomial(s, f) for f in (0.5, 1.0, 2.0))
    for nodes in range(MOST_NODES + 1):
        scaled = 0.5**nodes * half, whole, 2.0**nodes * twice
        off = scaled[2] - 3 * scaled[1] + 2 * scaled[0]  # R(2) - R(1) = 2 (R(1) - R(1/2))
        if (np.abs(off) <= AFFINE * sum(np.abs(part) for part in scaled)).all():
            return nodes
    raise ConfigError(
        "--break: found 'damper', but the gear does not hang on its damping as on one factor; "
        "allowed: tyre, or a damper whose damping changes nothing else"
    )


def _damped(study: Study, design: Mapping[str, float], factor: float) -> LinearGear:
    """The gear with its damping times a factor."""
    damper: Any = study.damper
    if damper.VISCOUS in design:
        return LinearModel(study).at(damper.with_damping(design, max(factor, FAINT)))
    own = getattr(damper.KIND, "model_fields", {})
    if "torsional_damping" in own and damper.torsional_damping > 0:
        return LinearModel(study.replace(damper__torsional_damping=factor * damper.torsional_damping)).at(design)
    raise ConfigError(
        f"--break: found 'damper', but damper.kind '{damper.kind}' has no damping that is one number above 0 (c_lambda, "
        "c_vane, torsional_damping); allowed: tyre"
    )
