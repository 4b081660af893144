"""What a sweep varies: its YAML file, and the points that follow from it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cache
from itertools import islice, product
from math import prod
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, TypeAdapter, ValidationError, model_validator
from scipy import stats

from ..errors import ConfigError
from ..quantities.units import Quantity
from ..study.config import load, parsed, text_of
from ..study.study import Study, unit_of
from .grid import Points, Sweep, study_or_problem

__all__ = ["load_sweep", "sweep_of"]

MOST_POINTS = 1_000_000

FEW = 100
"""Combinations in which a name is tried that is not valid by itself."""


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
    warm_start: Annotated[bool, Field(strict=True)] = True
    """Whether a point also starts from the design of a finished neighbour."""
    eigenvalue_speeds: Annotated[int, Field(strict=True, ge=2, le=10_000)] = 40
    """Speeds at which eigenvalues are stored."""

    @model_validator(mode="after")
    def _something(self) -> SweepSpec:
        if not self.vary and self.samples is None:
            raise ValueError("nothing is varied; give vary (lists and ranges by key) or samples")
        return self


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
    sampled = spec.samples.over if spec.samples else {}
    _disjoint(spec, sampled, where)
    base = _changed(base, spec.set, where)
    units: dict[str, str] = {}
    for group in (("vary", spec.vary), ("samples.over", sampled)):
        for key in group[1]:
            units[key] = _unit(base, key, where(*group[0].split("."), key))
    raw = {key: _values(given, units[key], where("vary", key)) for key, given in spec.vary.items()}
    samples = spec.samples.count if spec.samples else 1
    total = prod(map(len, raw.values())) * samples
    if total > MOST_POINTS:
        raise ConfigError(f"{where('vary' if raw else 'samples')}: makes {total} points; allowed: at most {MOST_POINTS}")
    axes = {key: _stored(base, key, raw, units[key], where("vary", key)) for key in raw}
    for key, shown in axes.items():
        if len(set(shown)) < len(shown):
            raise ConfigError(f"{where('vary', key)}: found a value twice; allowed: each once")
    points = Points(base, raw, axes, _draws(spec.samples, units, where) if spec.samples else {})
    sweep = Sweep(
        spec.name, spec.run, points, spec.warm_start, spec.eigenvalue_speeds, {key: unit for key, unit in units.items() if unit}
    )
    probes = sweep.probes()
    if len(probes) == total and all(point.study is None for point in probes):
        problem = probes[0].problem
        raise ConfigError(f"{where('vary' if spec.vary else 'samples')}: no point is a valid study; the first: {problem}")
    return sweep


def _disjoint(spec: SweepSpec, sampled: Mapping[str, Any], where: Any) -> None:
    """Refuse keys that say twice what a number is: one in two places, or a block and a key inside it."""
    for key in sampled:
        if key in spec.vary:
            raise ConfigError(f"{where('samples', 'over', key)}: is varied in a grid too; allowed: one of them")
    varied = [(("vary", key), key) for key in spec.vary] + [(("samples", "over", key), key) for key in sampled]
    fixed = [(("set", key), key) for key in spec.set]
    for place, key in varied + fixed:
        if "__" in key:
            raise ConfigError(f"{where(*place)}: is no key path; allowed: keys with dots between, as gear.caster_length")
        for other_place, other in varied + fixed:
            inside = key.startswith(f"{other}.") and not (place[0] != "set" and other_place[0] == "set")
            again = key == other and place[0] == "set" and other_place[0] != "set"
            if inside or again:
                words = f"is inside '{other}', which is given too" if inside else "is varied too"
                raise ConfigError(f"{where(*place)}: {words}; allowed: one of them")


def _changed(base: Study, changes: Mapping[str, Any], where: Any) -> Study:
    """The base with its changes, checked together: some hold only with each other."""
    try:
        return base.replace(**{key.replace(".", "__"): value for key, value in changes.items()}) if changes else base
    except ConfigError as error:
        problems = []
        for problem in error.problems:
            path = problem.partition(":")[0]
            own = [key for key in changes if path == key or path.startswith(f"{key}.") or key.startswith(f"{path}.")]
            problems.append(f"{where('set', own[0]) if own else where('set')}: {problem}")
        raise ConfigError(problems) from None


def _unit(base: Study, key: str, where: str) -> str:
    """SI unit of a key, empty for names and blocks."""
    try:
        unit_text = unit_of(base, key)
    except (AttributeError, KeyError, TypeError):
        _, problem = study_or_problem(base, {key: None})
        raise ConfigError(
            f"{where}: unknown key ({problem or 'not in the base study'}); allowed: a key path of the base"
        ) from None
    value: Any = base
    for part in key.split("."):
        value = getattr(value, part)
    return "" if isinstance(value, str) or key == "material" else unit_text


@cache
def _reader(unit: str) -> TypeAdapter:
    return TypeAdapter(Annotated[float, Quantity(unit)])


def _number(given: Any, unit: str, where: str) -> float:
    """Number in SI; signs and ranges are checked with the study."""
    try:
        return float(_reader(unit).validate_python(given))
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


def _stored(base: Study, key: str, raw: Mapping[str, list[Any]], unit: str, where: str) -> tuple[float | str, ...]:
    """Values of an axis as the study keeps them: numbers in SI, or names. Each must be valid by itself or with others."""
    shown: list[float | str] = []
    for given in raw[key]:
        if isinstance(given, float) or (
            isinstance(given, (int, str)) and not isinstance(given, bool) and unit not in ("", "1")
        ):
            shown.append(_number(given, unit or "1", where))
            continue
        study, problem = _study_with(base, key, given, raw)
        if study is None:
            if isinstance(given, int):
                shown.append(float(given))
                continue
            raise ConfigError(f"{where}: {problem}")
        value: Any = study
        for part in key.split("."):
            value = getattr(value, part)
        if isinstance(value, (list, tuple)) and len(value) == 1:  # a load stands for a list of one
            (value,) = value
        number = isinstance(value, (int, float)) and not isinstance(value, bool)
        shown.append(float(value) if number else str(getattr(value, "name", given)))
    if len({type(value) for value in shown}) > 1:
        raise ConfigError(f"{where}: found numbers and names; allowed: one kind")
    return tuple(shown)


def _study_with(base: Study, key: str, given: Any, raw: Mapping[str, list[Any]]) -> tuple[Study | None, str]:
    """The study with one value, alone or with values of the other axes: some are valid together only."""
    study, problem = study_or_problem(base, {key: given})
    if study is None:
        others = {other: values for other, values in raw.items() if other != key}
        for chosen in islice(product(*others.values()), FEW):
            study, _ = study_or_problem(base, {key: given} | dict(zip(others, chosen, strict=True)))
            if study is not None:
                break
    return study, problem


def _draws(samples: Samples, units: Mapping[str, str], where: Any) -> dict[str, np.ndarray]:
    """Values of all samples by key [SI]."""
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
    return {key: law.ppf(unit_cube[:, i]) for i, (key, law) in enumerate(laws.items())}


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
