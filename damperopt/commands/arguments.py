"""Text of the command line as numbers and records; what is wrong is said as for a file."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import numpy as np
from pydantic import TypeAdapter, ValidationError

from ..charts.plane import quantity_name, unit_of_quantity
from ..errors import ConfigError
from ..quantities.record import Speed
from ..quantities.units import Quantity, number
from ..reading import quoted
from ..study.disturbances import Disturbance
from ..study.study import Study

__all__ = ["axis_range", "choices", "disturbance_of", "quantity", "speed_grid", "speeds_of", "values_of"]

FASTEST = 1e4
"""Largest speed of a table [m/s]."""

MOST_SPEEDS = 10_000
"""Of a table: modes are followed from one to the next, a few thousand a second."""

_SHORT: dict[str, dict[str, str]] = {
    "release": {"yaw": "yaw_angle", "bending": "bending_angle", "string": "string_deflection"},
    "kick": {"yaw": "yaw_rate", "bending": "bending_rate"},
    "step": {"torque": "yaw_torque"},
    "unbalance": {},
}


def quantity(text: str, kind: Any, option: str) -> float:
    """Number with or without unit.

    Parameters
    ----------
    text : str
        Such as ``40`` or ``120 kt``; 120kt will do.
    kind : type
        Of `records`, such as `Speed`.
    option : str
        For the message.

    Returns
    -------
    float
        [SI]

    Raises
    ------
    ConfigError
        If it is not allowed.
    """
    try:
        return float(TypeAdapter(kind).validate_python(_number_or_text(text)))
    except ValidationError as error:
        raise ConfigError(f"{option}: {error.errors(include_url=False)[0]['msg']}") from None


def _number_or_text(text: str) -> float | str:
    value = number(text)
    return text if value is None else value


def disturbance_of(given: Mapping[str, Sequence[str]]) -> Disturbance:
    """Disturbance of options such as ``--release yaw=1deg,bending=0.5deg``.

    Parameters
    ----------
    given : mapping of str to sequence of str
        Texts by kind: release, kick, step, unbalance.

    Returns
    -------
    Disturbance

    Raises
    ------
    ConfigError
        If a text is not ``name=value`` with a name that the kind has and a value that it allows.
    """
    blocks: dict[str, dict[str, Any]] = {}
    for kind, texts in given.items():
        for part in (part for text in texts for part in text.split(",")):
            name, equals, value = (piece.strip() for piece in part.partition("="))
            if not equals:
                raise ConfigError(f"--{kind}: found {quoted(part)}; allowed: name=value, such as {_example(kind)}")
            block, key = blocks.setdefault(kind, {}), _SHORT[kind].get(name, name)
            if key in block:
                raise ConfigError(f"--{kind}: names {quoted(name)} twice; allowed: each once")
            block[key] = _number_or_text(value)
    try:
        return Disturbance.model_validate(blocks)
    except ValidationError as error:
        raise ConfigError([_in_words(problem) for problem in error.errors(include_url=False)]) from None


def _example(kind: str) -> str:
    return {"release": "yaw=1deg", "kick": "yaw=0.5rad/s", "step": "torque=2kNm", "unbalance": "moment=0.01"}[kind]


def _in_words(problem: Any) -> str:
    kind, *rest = (str(step) for step in problem["loc"])
    if problem["type"] == "extra_forbidden":
        names = Disturbance.model_fields[kind].annotation.__args__[0].model_fields  # type: ignore[union-attr]  # Block | None
        return f"--{kind}: {quoted(rest[0])} is unknown; allowed: {', '.join(names)}"
    return f"--{kind}: {' '.join([*rest, problem['msg']])}"


def speed_grid(text: str, study: Study) -> np.ndarray:
    """Speeds [m/s] of ``MIN:MAX:STEP``; 400 over the envelope if empty."""
    if not text:
        low, high = study.envelope.speed.min, study.envelope.speed.max
        return np.unique(np.linspace(low, high, 400))
    allowed = (
        f"MIN:MAX:STEP in m/s, 0 < MIN <= MAX, STEP > 0, MAX at most {FASTEST:g}, at most {MOST_SPEEDS} speeds, such as 5:100:1"
    )
    parts = [number(part) for part in text.split(":")]
    if len(parts) != 3 or None in parts:
        raise ConfigError(f"--speeds: found {quoted(text)}; allowed: {allowed}")
    low, high, step = (part for part in parts if part is not None)
    if not (0 < low <= high <= FASTEST and 0 < step < math.inf and (high - low) / step < MOST_SPEEDS):
        raise ConfigError(f"--speeds: found {quoted(text)}; allowed: {allowed}")
    count = int(np.floor((high - low) / step * (1 + 1e-12))) + 1
    return low + step * np.arange(count)


def speeds_of(text: str, option: str, most: int) -> list[float]:
    """Speeds [m/s] of a comma list such as ``5,120kt``: ascending, each once."""
    found = sorted({quantity(part.strip(), Speed, option) for part in text.split(",")})
    if len(found) > most or found[-1] > FASTEST:
        raise ConfigError(
            f"{option}: found {quoted(text)}; allowed: at most {most} speeds up to {FASTEST:g} m/s, such as 5,120kt"
        )
    return found


def axis_range(text: str, study: Study, option: str) -> tuple[str, float, float]:
    """Name and range [SI] of ``NAME=LOW:HIGH``, such as c_lambda=0:2e5 or 'L=300 mm:0.8 m'."""
    name, equals, given = text.partition("=")
    low, colon, high = given.partition(":")
    if not (equals and colon):
        raise ConfigError(f"{option}: found {quoted(text)}; allowed: NAME=LOW:HIGH, such as c_lambda=0:2e5")
    return name.strip(), _in_unit(study, name.strip(), low, option), _in_unit(study, name.strip(), high, option)


def values_of(text: str, study: Study, option: str) -> tuple[str, list[float]]:
    """Name and values [SI] of ``NAME=VALUE,VALUE``, such as speed=40,80,160."""
    name, equals, given = text.partition("=")
    if not (equals and given.strip()):
        raise ConfigError(f"{option}: found {quoted(text)}; allowed: NAME=VALUE,VALUE, such as speed=40,80,160")
    values = [_in_unit(study, name.strip(), part, option) for part in given.split(",")]
    if len(set(values)) < len(values):
        raise ConfigError(f"{option}: found {quoted(text)}, a value twice; allowed: different values")
    return name.strip(), values


def _in_unit(study: Study, name: str, text: str, option: str) -> float:
    if len(name) > 100:
        raise ConfigError(
            f"{option}: {quoted(name)} is unknown; allowed: speed, load, a design variable or a key path of the study"
        )
    unit = unit_of_quantity(study, quantity_name(study, name))
    return quantity(text.strip(), Annotated[float, Quantity(unit)], f"{option}: {name}")


def choices(text: str, allowed: tuple[str, ...], option: str) -> list[str]:
    """Names of a comma list, or all of them."""
    if text == "all":
        return list(allowed)
    chosen = [part.strip() for part in text.split(",") if part.strip()]
    unknown = [part for part in chosen if part not in allowed]
    if unknown:
        raise ConfigError(f"{option}: {quoted(unknown[0])} is unknown; allowed: {', '.join(allowed)}, or all")
    return list(dict.fromkeys(chosen))
