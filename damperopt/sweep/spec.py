"""What a sweep varies: its YAML file, and the points that follow from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from hashlib import sha256
from importlib.metadata import version
from itertools import product
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, model_validator
from scipy import stats

from ..errors import ConfigError
from ..quantities.units import Quantity
from ..study.config import load, parsed, text_of
from ..study.study import Study, unit_of

__all__ = ["Point", "Sweep", "load_sweep", "sweep_of"]

MOST_POINTS = 1_000_000


class _Record(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")


class Range(_Record):
    """Evenly spaced values, or in even ratios."""

    start: Any = Field(alias="from")
    """First value, with a unit as the key takes it."""
    stop: Any = Field(alias="to")
    """Last value."""
    points: Annotated[int, Field(strict=True, ge=2, le=100_000)]
    """How many values, ends included."""
    spacing: Literal["linear", "log"] = "linear"
    """Even steps, or even ratios."""


class Distribution(_Record):
    """One of the families; numbers with units as the key takes them."""

    uniform: tuple[Any, Any] | None = None
    """Between two ends: [low, high]."""
    log_uniform: tuple[Any, Any] | None = None
    """Between two ends, even in the logarithm: [low, high]."""
    normal: tuple[Any, Any] | None = None
    """Gaussian: [mean, standard deviation]."""
    triangular: tuple[Any, Any, Any] | None = None
    """Linear up to a mode and down again: [low, mode, high]."""

    @model_validator(mode="after")
    def _one(self) -> Distribution:
        if len(self.model_fields_set) != 1:
            raise ValueError("found none or several; give one of uniform, log_uniform, normal, triangular")
        return self


class Samples(_Record):
    """Points drawn at random or evenly spread."""

    method: Literal["sobol", "latin_hypercube", "random"] = "sobol"
    """How points are spread."""
    count: Annotated[int, Field(strict=True, ge=1, le=MOST_POINTS)]
    """Samples at every point of the grid."""
    seed: Annotated[int, Field(strict=True, ge=0)] = 0
    """The same seed gives the same samples."""
    over: dict[str, Distribution] = Field(min_length=1)
    """A distribution for each key path of the study."""


class SweepSpec(_Record):
    """A sweep as its file gives it."""

    name: str = "sweep"
    """Of the sweep; its folder carries it."""
    base: str
    """The study that is varied: a path from the folder of this file."""
    run: Literal["optimise", "analyse"] = "optimise"
    """What is done at every point."""
    set: dict[str, Any] = {}
    """Changes of the base by key path, before anything is varied."""
    vary: dict[str, list[Any] | Range] = {}
    """A grid: a list of values or a range {from, to, points} for each key path."""
    samples: Samples | None = None
    """Points drawn over key paths, at every point of the grid."""
    warm_start: bool = True
    """Whether a point also starts from the design of a finished neighbour."""
    eigenvalue_speeds: Annotated[int, Field(strict=True, ge=2, le=10_000)] = 40
    """Speeds at which eigenvalues are stored."""

    @model_validator(mode="after")
    def _something(self) -> SweepSpec:
        if not self.vary and self.samples is None:
            raise ValueError("nothing is varied; give vary (lists and ranges by key) or samples")
        return self


@dataclass(frozen=True)
class Point:
    """A study of a sweep.

    Attributes
    ----------
    index : int
    values : dict
        Of what is varied, by key path: numbers [SI] or names.
    study : Study or None
        None where the values make none.
    problem : str
        Why they do not.
    """

    index: int
    values: dict[str, float | str]
    study: Study | None
    problem: str = ""


@dataclass(frozen=True)
class Sweep:
    """A sweep that can be run.

    Attributes
    ----------
    name : str
    run : str
        ``optimise`` or ``analyse``.
    axes : dict
        Values of each key of the grid, in order; empty without one.
    sampled : tuple of str
        Keys that are sampled.
    count : int
        Samples for every point of the grid; 1 without samples.
    points : tuple of Point
        The grid in the order of the axes, the last one fastest; samples within.
    warm_start : bool
        Whether a point takes its nearest finished neighbour's design for the study's own start; the other starts stay.
    eigenvalue_speeds : int
        Speeds at which eigenvalues are stored.
    units : dict
        SI unit of each key with numbers.
    """

    name: str
    run: str
    axes: dict[str, tuple[float | str, ...]]
    sampled: tuple[str, ...]
    count: int
    points: tuple[Point, ...]
    warm_start: bool
    eigenvalue_speeds: int
    units: dict[str, str]

    def key(self, point: Point) -> str:
        """What identifies the work at a point: the question, and the program that answers it."""
        text = point.study.model_dump_json() if point.study else point.problem
        return sha256(f"{version('damperopt')} {self.run} {self.eigenvalue_speeds} {text}".encode()).hexdigest()


def load_sweep(path: str | Path) -> Sweep:
    """Read a sweep; its ``base`` is a path from the file's folder.

    Parameters
    ----------
    path : str or Path

    Returns
    -------
    Sweep

    Raises
    ------
    ConfigError
        With one message per problem, each with file, line and key.
    """
    path = Path(path)
    spec, lines = parsed(text_of(path), str(path), SweepSpec)

    def where(*keys: Any) -> str:
        return f"{path}:{lines.get(keys, 1)}: {'.'.join(map(str, keys))}"

    try:
        base = load(path.parent / spec.base)
    except ConfigError as error:
        raise ConfigError([f"{where('base')}: {problem}" for problem in error.problems]) from None
    return _sweep(spec, base, where)


def sweep_of(base: Study, **settings: Any) -> Sweep:
    """A sweep without a file.

    Parameters
    ----------
    base : Study
    **settings : object
        Keys of a sweep's file but ``base``: ``vary={"requirements.stability_margin": [0.1, 0.2]}``.

    Returns
    -------
    Sweep

    Raises
    ------
    ConfigError
        As `load_sweep`.
    """
    try:
        spec = SweepSpec.model_validate({"base": base.name, **settings})
    except ValidationError as error:
        raise ConfigError([f"{'.'.join(map(str, p['loc']))}: {p['msg']}" for p in error.errors(include_url=False)]) from None
    return _sweep(spec, base, lambda *keys: ".".join(map(str, keys)))


def _sweep(spec: SweepSpec, base: Study, where: Any) -> Sweep:
    for key, value in spec.set.items():
        changed, problem = _study(base, {key: value})
        if changed is None:
            raise ConfigError(f"{where('set', key)}: {problem}")
        base = changed
    units: dict[str, str] = {}
    for group in (("vary", spec.vary), ("samples.over", spec.samples.over if spec.samples else {})):
        for key in group[1]:
            units[key] = _unit(base, key, where(*group[0].split("."), key))
    raw = {key: _values(given, units[key], where("vary", key)) for key, given in spec.vary.items()}
    axes = {key: _stored(base, key, values, where("vary", key)) for key, values in raw.items()}
    for key, shown in axes.items():
        if len(set(shown)) < len(shown):
            raise ConfigError(f"{where('vary', key)}: found a value twice; allowed: each once")
    draws: list[dict[str, float]] = [{}] if spec.samples is None else _draws(spec.samples, units, where)
    if both := set(raw) & set(draws[0]):
        raise ConfigError(f"{where('samples', 'over', min(both))}: is varied in a grid too; allowed: one of them")
    total = int(np.prod([len(values) for values in raw.values()])) * len(draws)
    if total > MOST_POINTS:
        raise ConfigError(f"{where('vary')}: makes {total} points; allowed: at most {MOST_POINTS}")
    points: list[Point] = []
    for chosen in product(*(zip(raw[key], axes[key], strict=True) for key in raw)):
        for draw in draws:
            given = {key: value for key, (value, _) in zip(raw, chosen, strict=True)} | draw
            shown_values = {key: shown for key, (_, shown) in zip(raw, chosen, strict=True)} | draw
            study, problem = _study(base, given)
            points.append(Point(len(points), shown_values, study, problem))
    if all(point.study is None for point in points):
        raise ConfigError(
            f"{where('vary' if spec.vary else 'samples')}: no point is a valid study; the first: {points[0].problem}"
        )
    sampled = tuple(spec.samples.over) if spec.samples else ()
    return Sweep(
        spec.name, spec.run, axes, sampled, len(draws), tuple(points), spec.warm_start, spec.eigenvalue_speeds,
        {key: unit for key, unit in units.items() if unit},
    )  # fmt: skip


def _study(base: Study, values: Mapping[str, Any]) -> tuple[Study | None, str]:
    try:
        return base.replace(**{key.replace(".", "__"): value for key, value in values.items()}), ""
    except ConfigError as error:
        return None, "; ".join(error.problems)


def _unit(base: Study, key: str, where: str) -> str:
    """SI unit of a key, empty for names and blocks."""
    try:
        unit_text = unit_of(base, key)
    except (AttributeError, KeyError):
        _, problem = _study(base, {key: None})
        raise ConfigError(
            f"{where}: unknown key ({problem or 'not in the base study'}); allowed: a key path of the base"
        ) from None
    value: Any = base
    for part in key.split("."):
        value = getattr(value, part)
    return "" if isinstance(value, str) or key == "material" else unit_text


def _number(given: Any, unit: str, where: str) -> float:
    """Number in SI; signs and ranges are checked with the study."""
    try:
        return float(TypeAdapter(Annotated[float, Quantity(unit)]).validate_python(given))
    except ValidationError as error:
        raise ConfigError(f"{where}: {error.errors(include_url=False)[0]['msg']}") from None


def _values(given: Sequence[Any] | Range, unit: str, where: str) -> list[Any]:
    if not isinstance(given, Range):
        if not given:
            raise ConfigError(f"{where}: found an empty list; allowed: at least one value")
        return list(given)
    if not unit:
        raise ConfigError(f"{where}: a range of names; allowed: a list")
    low, high = _number(given.start, unit, f"{where}.from"), _number(given.stop, unit, f"{where}.to")
    if not low < high or (given.spacing == "log" and low <= 0):
        words = "0 < from < to" if given.spacing == "log" else "from < to"
        raise ConfigError(f"{where}: found {low:g} to {high:g}; allowed: {words}")
    space = np.geomspace if given.spacing == "log" else np.linspace
    return [float(value) for value in space(low, high, given.points)]


def _stored(base: Study, key: str, values: Sequence[Any], where: str) -> tuple[float | str, ...]:
    """Values of an axis as the study keeps them: numbers in SI, or names. Each must be valid by itself or with others."""
    shown: list[float | str] = []
    for given in values:
        study, problem = _study(base, {key: given})
        if study is None:
            if isinstance(given, (int, float)):
                shown.append(float(given))
                continue
            raise ConfigError(f"{where}: {problem}")
        value: Any = study
        for part in key.split("."):
            value = getattr(value, part)
        if isinstance(value, (list, tuple)) and len(value) == 1:  # a load stands for a list of one
            (value,) = value
        if isinstance(value, float):
            shown.append(value)
        else:
            shown.append(str(getattr(value, "name", given)))
    if len({type(value) for value in shown}) > 1:
        raise ConfigError(f"{where}: found numbers and names; allowed: one kind")
    return tuple(shown)


def _draws(samples: Samples, units: Mapping[str, str], where: Any) -> list[dict[str, float]]:
    """Values of each sample by key [SI]."""
    laws = {key: _law(given, units[key], where("samples", "over", key)) for key, given in samples.over.items()}
    n, d = samples.count, len(laws)
    rng = np.random.default_rng(samples.seed)
    if samples.method == "sobol":
        engine: Any = stats.qmc.Sobol(d, rng=rng)
        unit_cube = engine.random_base2(int(np.ceil(np.log2(n))))[:n]
    elif samples.method == "latin_hypercube":
        unit_cube = stats.qmc.LatinHypercube(d, rng=rng).random(n)
    else:
        unit_cube = rng.random((n, d))
    columns = [law.ppf(unit_cube[:, i]) for i, law in enumerate(laws.values())]
    return [dict(zip(laws, map(float, row), strict=True)) for row in zip(*columns, strict=True)]


def _law(given: Distribution, unit: str, where: str) -> Any:
    """Frozen distribution in SI."""
    if not unit:
        raise ConfigError(f"{where}: is no number; allowed: keys with numbers")
    (family,) = given.model_fields_set
    numbers = [_number(value, unit, f"{where}.{family}") for value in getattr(given, family)]
    if family == "normal":
        if numbers[1] <= 0:
            raise ConfigError(f"{where}.normal: found a deviation of {numbers[1]:g}; allowed: [mean, deviation > 0]")
        return stats.norm(*numbers)
    low, high = numbers[0], numbers[-1]
    if not low < high or (family == "log_uniform" and low <= 0) or not low <= numbers[-2] <= high:
        words = {"uniform": "[low, high]", "log_uniform": "[low > 0, high]", "triangular": "[low, mode, high]"}[family]
        raise ConfigError(f"{where}.{family}: found {', '.join(f'{n:g}' for n in numbers)}; allowed: {words}")
    if family == "triangular":
        return stats.triang((numbers[1] - low) / (high - low), loc=low, scale=high - low)
    return stats.loguniform(low, high) if family == "log_uniform" else stats.uniform(low, high - low)
