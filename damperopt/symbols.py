"""Symbolic twin of a study: the same records with a CasADi symbol for every number that a result can depend on.

The physics modules read `gear.caster_length` and do not care whether it is a float or a symbol. With symbols, one
graph serves every value, and the solver returns the derivative of the optimum with respect to each of them.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import casadi as ca
from pydantic import BaseModel

from .quantities.record import Record
from .study.study import Study

__all__ = ["SymbolicStudy", "data_names", "data_values", "symbolic"]

_DATA_BLOCKS = ("gear", "tyre", "damper", "material", "requirements", "loads", "mass")


@dataclass(frozen=True)
class SymbolicStudy:
    """A study whose numbers are symbols.

    Attributes
    ----------
    study : Study
        Records with `casadi.SX` in place of floats (blocks gear, tyre, damper, material, requirements, loads, mass).
    data : casadi.SX
        (n,) the symbols, in the order of `names`.
    names : tuple of str
        Key path of each symbol.
    """

    study: Any
    data: ca.SX
    names: tuple[str, ...]


def symbolic(study: Study) -> SymbolicStudy:
    """Twin of `study` with symbols for its numbers.

    Parameters
    ----------
    study : Study

    Returns
    -------
    SymbolicStudy
    """
    names = data_names(study)
    symbols = {name: ca.SX.sym(name) for name in names}

    def twin(record: BaseModel, path: str) -> BaseModel:
        fields = {}
        for key in type(record).model_fields:
            value, inner = getattr(record, key), f"{path}.{key}"
            if isinstance(value, BaseModel) and key not in _constants(record):
                value = twin(value, inner)
            elif isinstance(value, Mapping) and key not in _constants(record):
                value = {**value, **{name: twin(part, f"{inner}.{name}") for name, part in _records(value)}}
            fields[key] = symbols.get(inner, value)
        return type(record).model_construct(**fields)

    blocks = {key: getattr(study, key) for key in Study.model_fields}
    for key in _DATA_BLOCKS:
        if blocks[key] is not None:
            blocks[key] = twin(blocks[key], key)
    return SymbolicStudy(Study.model_construct(**blocks), ca.vertcat(*symbols.values()), names)


def data_names(study: Study) -> tuple[str, ...]:
    """Key paths of the numbers of `study` that a result can depend on."""
    return tuple(name for name, _ in _numbers(study))


def data_values(study: Study) -> tuple[float, ...]:
    """Their values [SI], in the same order."""
    return tuple(value for _, value in _numbers(study))


def _numbers(study: Study) -> list[tuple[str, float]]:
    def walk(record: BaseModel, path: str) -> list[tuple[str, float]]:
        found: list[tuple[str, float]] = []
        for key in type(record).model_fields:
            value = getattr(record, key)
            if key in _constants(record):
                continue
            if isinstance(value, BaseModel):
                found += walk(value, f"{path}.{key}")
            elif isinstance(value, Mapping):
                found += [number for name, part in _records(value) for number in walk(part, f"{path}.{key}.{name}")]
            elif isinstance(value, float):
                found.append((f"{path}.{key}", value))
        return found

    blocks = ((key, getattr(study, key)) for key in _DATA_BLOCKS)
    return [number for key, block in blocks if block is not None for number in walk(block, key)]


def _records(block: Mapping[str, Any]) -> Iterator[tuple[str, BaseModel]]:
    """Records that stand under names of the user."""
    return ((name, part) for name, part in block.items() if isinstance(part, BaseModel))


def _constants(record: BaseModel) -> tuple[str, ...]:
    return record.constants() if isinstance(record, Record) else ()
