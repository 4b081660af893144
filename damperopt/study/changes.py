"""Changes of a study by key path, as data: into blocks only, never through a number, a name or a list."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel

from ..errors import ConfigError
from ..reading import printable, quoted

__all__ = ["changed"]


def changed(data: Mapping[str, Any], changes: Mapping[str, Any]) -> dict[str, Any]:
    """The data of a study with other values at some key paths.

    Parameters
    ----------
    data : mapping
        Blocks of keys, as a file has them.
    changes : mapping of str to object
        New values by key path with dots: ``{"envelope.speed.max": 80}``.

    Returns
    -------
    dict
        New; an optional block that is missing is begun.

    Raises
    ------
    ConfigError
        Where a path leads through what is no block.

    Examples
    --------
    >>> changed({"gear": {"order": 3}}, {"gear.order": 5})
    {'gear': {'order': 5}}
    """
    new = dict(data)
    for path, value in changes.items():
        *parents, leaf = path.split(".")
        block = new
        for depth, key in enumerate(parents, 1):
            inner = block.get(key)
            if inner is not None and not isinstance(inner, Mapping):
                here = printable(".".join(parents[:depth]))
                kind = "a list" if isinstance(inner, (list, tuple)) else quoted(inner)
                raise ConfigError(
                    f"{printable(path)}: {here} is {kind} and has no keys; allowed: a new value of {here} as a whole"
                )
            block[key] = dict(inner or {})
            block = block[key]
        block[leaf] = value.model_dump() if isinstance(value, BaseModel) else value
    return new
