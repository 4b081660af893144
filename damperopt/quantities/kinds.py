"""Every model of a room by its tag: the files of its folder, and those that other distributions bring."""

from __future__ import annotations

import pkgutil
import reprlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points
from typing import Annotated, Any, Literal, TypeAlias, TypeVar, Union, get_args, get_origin

from pydantic import BeforeValidator, Discriminator, GetJsonSchemaHandler, Tag
from pydantic_core import CoreSchema

from ..errors import ConfigError
from .record import Record, refuse

__all__ = ["home_of", "kinds", "one_of", "tags_of", "union_of"]

T = TypeVar("T", bound=Record)

Rewrite: TypeAlias = Callable[[dict[str, Any]], dict[str, Any]]

HOMES: dict[type[Record], str] = {}
"""Where each kind that was found comes from, for messages."""

PACKAGE = __name__.rpartition(".quantities")[0]


def tags_of(kind: type[Record], tag: str) -> tuple[str, ...]:
    """Values of the tag of a class, the one that is written first; a class without one is a base and has none."""
    field = kind.model_fields.get(tag)
    return get_args(field.annotation) if field is not None and get_origin(field.annotation) is Literal else ()


def home_of(kind: type[Record]) -> str:
    """Class and distribution of a kind, for messages: a plug-in is mended by those who made it."""
    return f"{kind.__name__} of {HOMES.get(kind, kind.__module__)}"


def kinds(folder: str, base: type[T], tag: str) -> dict[str, type[T]]:
    """Classes of a room by their tag.

    Parameters
    ----------
    folder : str
        Of this package, such as ``gears`` or ``tyres.laws``; its files are imported once.
    base : type
        Base class; `base.GROUP` names the entry points through which other distributions add to the room.
    tag : str
        Field whose literal value tells the classes apart.

    Returns
    -------
    dict of str to type
        Those of the package first, in the order of their files.

    Raises
    ------
    ConfigError
        If a tag is used twice, or what another distribution brings cannot be loaded or is no such class.
    """
    return dict(_kinds(folder, base, tag))


@cache
def _kinds(folder: str, base: type[T], tag: str) -> dict[str, type[T]]:
    found: dict[str, type[T]] = {}
    taken: dict[str, type[T]] = {}  # older spellings of a tag included

    def add(kind: type[T], source: str) -> None:
        HOMES[kind] = source
        for name in tags_of(kind, tag):
            other = taken.setdefault(name, kind)
            if other is not kind:
                raise ConfigError(f"{tag} '{name}' is used twice, by {home_of(other)} and {home_of(kind)}; allowed: each once")
        found.update((name, kind) for name in tags_of(kind, tag)[:1])

    package = import_module(f"{PACKAGE}.{folder}")
    for _, name, _ in pkgutil.iter_modules(package.__path__):
        module = import_module(f"{package.__name__}.{name}")
        for thing in vars(module).values():
            if isinstance(thing, type) and issubclass(thing, base) and thing.__module__ == module.__name__:
                add(thing, f"damperopt ({folder}/{name}.py)")
    for point in entry_points(group=getattr(base, "GROUP", "")):
        source = f"{point.dist.name if point.dist else 'a plug-in'} ({point.value})"
        try:
            thing = point.load()
        except Exception as error:  # whatever the plug-in's code raises: it is named, and nothing goes on without it
            raise ConfigError(f"plug-in {source} cannot be loaded: {type(error).__name__}: {error}") from error
        if not (isinstance(thing, type) and issubclass(thing, base)) or not tags_of(thing, tag):
            wanted = f"a class derived from {base.__module__}.{base.__name__} with {tag}: Literal['...']"
            raise ConfigError(f"plug-in {source} is no {base.__name__}; allowed: {wanted}")
        add(thing, source)
    return found


def one_of(folder: str, base: type[Record], tag: str, rewrite: Rewrite = dict, short: bool = False) -> Any:
    """Field type of a study: one of the kinds of a room, told apart by `tag`.

    Parameters
    ----------
    folder, base, tag
        As for `kinds`.
    rewrite : callable
        Block -> block with the tag as it is written today; for older spellings and defaults.
    short : bool
        Whether the tag alone may stand for a block without other keys.

    Returns
    -------
    type
        With its JSON Schema.
    """
    return union_of(kinds(folder, base, tag), (tag,), rewrite, short)


def union_of(classes: Mapping[str, type[Record]], tags: tuple[str, ...], rewrite: Rewrite = dict, short: bool = False) -> Any:
    """Field type of classes that one tag, or several together, tell apart.

    Parameters
    ----------
    classes : mapping of str to type
        By the values of the tags, with a space between them.
    tags : tuple of str
    rewrite, short
        As for `one_of`.
    """
    first = tags[0]
    spellings = {
        (tag, other): tags_of(kind, tag)[0] for kind in classes.values() for tag in tags for other in tags_of(kind, tag)
    }

    def named(data: Any) -> str:
        given = (data.get(tag) if isinstance(data, dict) else getattr(data, tag, None) for tag in tags)
        return " ".join(map(str, given))

    def prepared(data: Any) -> Any:
        alone = short and isinstance(data, str)
        if alone:
            data = {first: data}
        if not isinstance(data, dict):
            return data
        given, data = data, rewrite(dict(data))
        data |= {tag: spellings.get((tag, data[tag]), data[tag]) for tag in tags if isinstance(data.get(tag), str)}
        if named(data) not in classes:
            found = data.get(first)
            written = first if first in given else next((key for key in given if key not in data), first)
            raise refuse(
                "" if alone else written,
                "missing key" if found is None else f"{reprlib.repr(found)} is unknown",
                ", ".join(classes),
            )
        return data

    def chosen(data: Any) -> str | None:
        return f"<{named(data)}>" if named(data) in classes else None

    options = tuple(Annotated[kind, Tag(f"<{name}>")] for name, kind in classes.items())
    more = (BeforeValidator(prepared), *([_TagAlone(tuple(classes))] if short else []))
    if len(options) == 1:
        return Annotated[options[0], *more]
    return Annotated[Union[options], Discriminator(chosen), *more]  # noqa: UP007  # built at run time


@dataclass(frozen=True)
class _TagAlone:
    """JSON Schema of a block that its tag alone may stand for."""

    names: tuple[str, ...]

    def __get_pydantic_json_schema__(self, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(self.names)}, handler(schema)]}
