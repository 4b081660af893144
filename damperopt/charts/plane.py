"""A plane of two quantities of a study: state matrices, and the spectral abscissa beyond the margin, at any of its points."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import casadi as ca
import numpy as np

from ..errors import ConfigError
from ..stability.delay import Frozen, frozen_of, rightmost
from ..stability.linear import LinearModel
from ..study.components import unit_of_name
from ..study.study import Study, unit_of
from ..symbols import data_names, data_values

__all__ = ["OPERATING", "Axis", "Plane", "Tally", "quantity_name", "unit_of_quantity"]

OPERATING = {"speed": "m/s", "vertical_load": "N"}
"""Quantities of the operating point, which no design can choose."""

BATCH = 20_000
"""Matrices that are in memory at once."""

SHOWN = 6
"""Rightmost eigenvalues that are looked at where there are infinitely many."""


def quantity_name(study: Study, text: str) -> str:
    """Full name of what a chart may vary.

    Parameters
    ----------
    study : Study
    text : str
        ``speed``, ``vertical_load`` (or ``load``), a design variable, or a key path of a number, whose last part is enough
        where it is unique: ``caster_length``.

    Returns
    -------
    str

    Raises
    ------
    ConfigError
        If there is no such quantity, or more than one.
    """
    text = {"load": "vertical_load", "V": "speed", "F_z": "vertical_load"}.get(text, text)
    model_names = (*OPERATING, *study.start)
    if text in model_names:
        return text
    paths = [name for name in data_names(study) if name.split(".")[0] in ("gear", "tyre", "damper", "material")]
    found = [name for name in paths if name == text or name.endswith("." + text)]
    if len(found) == 1:
        return found[0]
    if found:
        raise ConfigError(f"'{text}' is several quantities; allowed: one of {', '.join(found)}")
    raise ConfigError(f"'{text}' is unknown; allowed: {', '.join((*model_names, *paths))}")


def unit_of_quantity(study: Study, name: str) -> str:
    """SI unit of a quantity by its full name."""
    return OPERATING.get(name) or (unit_of_name(name) if name in study.variable_names else unit_of(study, name))


@dataclass(frozen=True)
class Axis:
    """A quantity and its range [SI]."""

    name: str
    low: float
    high: float
    unit: str

    @classmethod
    def of(cls, study: Study, name: str, low: float, high: float) -> Axis:
        """Axis of a study.

        Parameters
        ----------
        study : Study
        name : str
            As `quantity_name` takes it.
        low, high : float
            [SI]

        Returns
        -------
        Axis

        Raises
        ------
        ConfigError
            If the range is empty or not finite, or lies where the model does not exist.
        """
        full = quantity_name(study, name)
        unit = unit_of_quantity(study, full)
        if not -np.inf < low < high < np.inf:
            raise ConfigError(f"{name}: found the range {low:g} to {high:g}; allowed: a finite range, low < high, in {unit}")
        lowest = 0.0 if full in (*OPERATING, *study.variable_names) else -np.inf
        if low < lowest or (full == "speed" and low == 0):
            raise ConfigError(f"{name}: found {low:g} {unit}; allowed: {'> 0' if full == 'speed' else '>= 0'}")
        if full == "vertical_load" and (words := next(filter(None, map(study.beyond_data, (low, high))), "")):
            raise ConfigError(
                f"{name}: the range {low:g} to {high:g} N {words}; allowed: loads that tyre and strut have data for"
            )
        if lowest == -np.inf:
            for end in (low, high):
                study.replace(**{full.replace(".", "__"): float(end)})  # what a study may not have, a chart may not show
        return cls(full, low, high, unit)

    def at(self, fraction: np.ndarray) -> np.ndarray:
        """Value at a fraction of the range."""
        return self.low + (self.high - self.low) * fraction


class Tally:
    """Counts the matrices whose eigenvalues were computed; the planes that share it add to it."""

    def __init__(self) -> None:
        self.count = 0

    def add(self, more: int) -> None:
        """Count so many more."""
        self.count += more


@dataclass(frozen=True)
class Plane:
    """Spectral abscissa over two quantities, each as a fraction 0 to 1 of its range.

    Parameters
    ----------
    study : Study
    x, y : Axis
    design : mapping
        Design variables by name [SI].
    speed, load : float
        Where they are not varied [m/s], [N].
    margin : float
        [1/s]
    fixed : mapping
        Other quantities that are not those of the study, by full name.
    model : LinearModel or None
        Of the study, if it is at hand; built when first needed otherwise.
    tally : Tally
        Of the eigenvalues that are computed.
    """

    study: Study
    x: Axis
    y: Axis
    design: Mapping[str, float]
    speed: float
    load: float
    margin: float = 0.0
    fixed: Mapping[str, float] = field(default_factory=dict)
    model: LinearModel | None = field(default=None, compare=False, repr=False)
    tally: Tally = field(default_factory=Tally, compare=False, repr=False)

    def __post_init__(self) -> None:
        if self.x.name == self.y.name:
            raise ConfigError(f"{self.x.name}: found on both axes; allowed: two different quantities")
        if "vertical_load" not in (self.x.name, self.y.name) and (words := self.study.beyond_data(self.load)):
            raise ConfigError(f"load: {self.load:g} N {words}; allowed: loads that tyre and strut have data for")

    @property
    def evaluations(self) -> int:
        """State matrices whose eigenvalues were computed."""
        return self.tally.count

    @cached_property
    def _model(self) -> LinearModel:
        return LinearModel(self.study) if self.model is None else self.model

    @cached_property
    def _data_names(self) -> tuple[str, ...]:
        return data_names(self.study)

    @cached_property
    def _values(self) -> dict[str, float]:
        """Numbers of the study, of the design and of the operating point by name [SI]."""
        numbers = dict(zip(self._data_names, data_values(self.study), strict=True))
        return {**numbers, **self.design, "speed": self.speed, "vertical_load": self.load, **self.fixed}

    def matrices(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """State matrices (m, n, n) at fractions u, v (m,) of the ranges."""
        n, m = len(self._model.state_names), u.size
        inputs = [ca.DM(rows) for rows in self._rows(u, v)]
        return self._model.state_matrix(*inputs).full().reshape(n, m, n).transpose(1, 0, 2)

    def _rows(self, u: np.ndarray, v: np.ndarray) -> list[np.ndarray]:
        """Design, speed, load and numbers of the study, (k, m) each."""
        varied, m = {self.x.name: self.x.at(u), self.y.name: self.y.at(v)}, u.size

        def rows(keys: tuple[str, ...]) -> np.ndarray:
            return np.array([np.broadcast_to(varied.get(key, self._values[key]), m) for key in keys]).reshape(-1, m)

        return [rows(keys) for keys in (self._model.design_names, ("speed",), ("vertical_load",), self._data_names)]

    @property
    def delayed(self) -> bool:
        """Whether the tyre has a delay: then `matrices` have its contact line as a field, and `roots` are exact."""
        return self._model.structure is not None

    def frozen(self, u: np.ndarray, v: np.ndarray) -> Frozen:
        """The gear with a delay at fractions u, v (m,) of the ranges."""
        assert self._model.structure is not None
        design, speeds, loads, data = self._rows(u, v)
        return frozen_of(self._model.structure, design, speeds[0], loads[0], data)

    def roots(self, u: np.ndarray, v: np.ndarray, count: int | None = None) -> np.ndarray:
        """Eigenvalues (m, k) [1/s] at fractions u, v (m,) of the ranges; with a delay the `count` rightmost ones."""
        if self.delayed:
            return rightmost(self.frozen(u, v), SHOWN if count is None else count)
        return np.linalg.eigvals(self._existing(self.matrices(u, v)))

    def symbolic_matrix(self, x: ca.SX, y: ca.SX) -> ca.SX:
        """State matrix as an expression of the two quantities [SI]; all else is folded into constants."""
        varied = {self.x.name: x, self.y.name: y}

        def column(keys: tuple[str, ...]) -> ca.SX:
            return ca.vertcat(*(varied[key] if key in varied else ca.SX(self._values[key]) for key in keys))

        inputs = [column(keys) for keys in (self._model.design_names, ("speed",), ("vertical_load",), self._data_names)]
        return self._model.state_matrix(*inputs)

    def excess(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Spectral abscissa plus margin [1/s]: negative where the margin is kept."""
        u, v = np.broadcast_arrays(u, v)
        self.tally.add(u.size)
        starts = range(0, u.size, BATCH)
        parts = (self.roots(u.ravel()[i : i + BATCH], v.ravel()[i : i + BATCH], 1) for i in starts)
        values = [roots.real.max(axis=1) for roots in parts]
        return (np.concatenate(values) if values else np.zeros(0)).reshape(u.shape) + self.margin

    def rightmost(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Rightmost eigenvalue, that with a positive imaginary part of a pair [1/s]."""
        roots = self.roots(u, v)
        order = np.argmax(roots.real + 1e-12 * np.abs(roots.imag), axis=1)
        found = roots[np.arange(len(roots)), order]
        return found.real + 1j * np.abs(found.imag)

    def _existing(self, A: np.ndarray) -> np.ndarray:
        if not np.isfinite(A).all():
            raise ConfigError(
                f"{self.x.name}, {self.y.name}: the model does not exist in all of the range; allowed: a smaller one"
            )
        return A
