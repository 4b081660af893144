"""Slip law and contact line as the one block `tyre` of a study."""

from __future__ import annotations

import types
import warnings
from functools import cache
from typing import Annotated, Any, ClassVar

from pydantic.fields import FieldInfo

from ..errors import ConfigError
from ..quantities.kinds import home_of, kinds, one_of, tags_of, union_of
from ..quantities.record import refuse
from .base import AtLoad, ContactLine, SlipLaw, Tyre

__all__ = ["contact_lines", "slip_laws", "tyre_type"]


def slip_laws() -> dict[str, type[SlipLaw]]:
    """Slip laws by their tag."""
    return kinds("tyres.laws", SlipLaw, "law")


def contact_lines() -> dict[str, type[ContactLine]]:
    """Contact lines by their tag."""
    return kinds("tyres.contact", ContactLine, "contact")


DEFAULT_CONTACT = "memory"


@cache
def tyre(law: type[SlipLaw]) -> type[Any]:
    """Record class of a tyre with a slip law and any contact line."""
    twice = sorted((set(law.model_fields) & set(Tyre.model_fields)) - {"law"})
    if twice:
        raise ConfigError(f"{home_of(law)} declares '{twice[0]}', which every tyre has; allowed: other names")
    lines: Any = one_of("tyres.contact", ContactLine, "contact", _contact_block, short=True)
    given = {key: _or_none(Tyre.model_fields[key]) for key in law.GIVES}
    facts = {
        "LAW": law,
        "__doc__": law.__doc__,
        "__module__": __name__,
        "__annotations__": {"LAW": ClassVar[Any], "contact": lines, **given},
        "contact": contact_lines()[DEFAULT_CONTACT](contact=DEFAULT_CONTACT),
        **dict.fromkeys(given),
    }
    name = f"{law.__name__}Tyre"
    name = name if name not in globals() else f"{name}_{tags_of(law, 'law')[0]}"  # of a plug-in whose class is called the same
    made = types.new_class(name, (AtLoad, law, Tyre), {}, lambda namespace: namespace.update(facts))
    globals().setdefault(name, made)  # where pickle looks for it
    return made


def _or_none(field: FieldInfo) -> Any:
    """The type of a field that may be left out as well."""
    given: Any = Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation
    return given | None


def tyre_type() -> Any:
    """Field type of a study's block `tyre`, with its JSON Schema."""
    return union_of({name: tyre(law) for name, law in slip_laws().items()}, ("law",), _law_block)


def _contact_block(block: dict[str, Any]) -> dict[str, Any]:
    """``contact: {kind: name, ...}`` as a study has it, or with the tag under its own name."""
    if "kind" in block and "contact" in block:
        raise refuse("kind", "the contact line is named twice", "kind: one of " + ", ".join(contact_lines()))
    return {"contact": block.pop("kind"), **block} if "kind" in block else block


def _law_block(block: dict[str, Any]) -> dict[str, Any]:
    if block.get("law") == "straight_tangent":
        message = (
            "tyre.law 'straight_tangent' is now 'stiffness', with any contact line; the old name goes with the next version"
        )
        warnings.warn(message, FutureWarning, stacklevel=2)
    return {"law": "tr_r64", **block} if "size" in block else block  # a size says what it is
