"""From a YAML file to a `Study`; nothing else reads YAML. Every problem is reported with file, line and key path."""

from __future__ import annotations

import difflib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin

from pydantic import BaseModel, ValidationError

from ..errors import ConfigError
from ..quantities.record import quantity_of
from ..reading import printable, quoted, text_of
from . import schema
from .components import gears
from .document import dotted, few, read
from .study import Study

__all__ = ["is_sweep", "json_schema", "load", "loads", "parsed", "text_of"]

Record = TypeVar("Record", bound=BaseModel)


def load(path: str | Path) -> Study:
    """Read a study.

    Parameters
    ----------
    path : str or Path
        YAML file.

    Returns
    -------
    Study

    Raises
    ------
    ConfigError
        With one message per problem, each ``file:line: key.path: what; allowed: ...``.
    """
    return loads(text_of(path), str(path))


def loads(text: str, name: str = "<text>") -> Study:
    """Read a study from YAML text; `name` stands for the file in messages.

    Parameters
    ----------
    text : str
        YAML.
    name : str
        Name of the source, for messages.

    Returns
    -------
    Study

    Raises
    ------
    ConfigError
        As `load`.
    """
    return parsed(text, name, Study)[0]


def is_sweep(text: str, name: str) -> bool:
    """Whether a text describes a sweep: a base that is varied."""
    keys = read(text, name, "keys of a study or a sweep").data
    return "base" in keys and not {"gear", "tyre", "damper"} & set(keys)


def parsed(text: str, name: str, model: type[Record]) -> tuple[Record, dict[tuple, int]]:
    """A record of any class from YAML text, and the line of every key path in it.

    Parameters
    ----------
    text : str
    name : str
        Name of the source, for messages.
    model : type
        Class of the record.

    Returns
    -------
    tuple
        (record, lines)

    Raises
    ------
    ConfigError
        As `load`.
    """
    document = read(text, name, ", ".join(model.model_fields))
    data, lines, name = document.data, document.lines, printable(name)
    if document.empty:
        # an empty block would drop a requirement without a word
        raise ConfigError([
            f"{name}:{lines[path]}: {dotted(path)}: found nothing; allowed: {_allowed_at(path, model)}; or leave the key out"
            for path in document.empty
        ])  # fmt: skip
    try:
        return model.model_validate(data), lines
    except ValidationError as error:
        problems = [_message(problem, data, lines, name, model) for problem in error.errors(include_url=False)]
        raise ConfigError(few([text for _, text in sorted(set(problems))])) from None


def json_schema() -> dict[str, Any]:
    """JSON Schema of a study, for editors."""
    found = schema.json_schema(Study)
    for kind in gears().values():
        # older studies name a gear by its order
        order = kind.ORDER if kind.EXTENDS is None else gears()[kind.EXTENDS[0]].ORDER
        block = found["$defs"].get(kind.__name__)
        if order is not None and block is not None:
            block["properties"]["order"] = {
                "const": order,
                "description": f"An older name of this kind, or kind: {kind.__name__}.",
            }
            block["required"].remove("kind")
            block["anyOf"] = [{"required": ["kind"]}, {"required": ["order"]}]
    return found


def _message(problem: Any, data: Any, lines: dict[tuple, int], name: str, model: type[BaseModel]) -> tuple[int, str]:
    context = problem.get("ctx", {})
    path = _path_in_file(problem["loc"], data, problem["type"] == "missing") + tuple(
        filter(None, context.get("key", "").split("."))
    )
    known = path
    while known not in lines:
        known = known[:-1]
    what = _what(problem, path, model)
    return lines[known], f"{name}:{lines[known]}: {dotted(path)}: {what}"


def _path_in_file(location: Sequence[Any], data: Any, missing: bool) -> tuple:
    """Location without the tags of unions that pydantic inserts: what is not in the data, but for a key that is missing."""
    path: list[Any] = []
    for position, step in enumerate(location):
        inside = isinstance(data, dict) and step in data
        inside = inside or (isinstance(data, list) and isinstance(step, int) and step < len(data))
        if inside:
            data = data[step]
        elif position < len(location) - 1 or not missing:
            continue
        path.append(step)
    return tuple(path)


def _what(problem: Any, path: tuple, model: type[BaseModel]) -> str:
    kind, context = problem["type"], problem.get("ctx", {})
    if kind in ("quantity", "study"):
        return problem["msg"]
    found = quoted(problem.get("input"))
    if kind == "missing":
        return f"missing key; allowed: {_allowed_at(path, model)}"
    if kind == "extra_forbidden":
        siblings = _keys_at(path[:-1], model)
        close = difflib.get_close_matches(str(path[-1]), siblings, n=1)
        hint = f" (did you mean '{close[0]}'?)" if close else ""
        return f"unknown key{hint}; allowed: {', '.join(siblings) or 'none'}"
    if kind == "literal_error":
        return f"{found} is not one of the choices; allowed: {context['expected']}"
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        tags = "'nonlinear', 'linear', 'straight_tangent'"
        return f"{'missing' if kind.endswith('found') else quoted(context.get('tag'))} tyre law; allowed: law: {tags}"
    if kind.startswith("model_") or kind in ("dict_type", "model_type"):
        return f"found {found} instead of a block; allowed: a mapping with the keys {', '.join(_keys_at(path, model))}"
    if kind == "list_type":
        return f"found {found} instead of a list; allowed: a list of items, each {_allowed_at(path, model)}"
    return f"found {found}; {problem['msg'][0].lower()}{problem['msg'][1:]}; allowed: {_allowed_at(path, model)}"


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Record classes inside an annotation."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [model for part in getattr(annotation, "__args__", ()) for model in _models(part)]


def _fields_at(path: tuple, model: type[BaseModel]) -> list[Any]:
    fields: list[Any] = []
    models: list[type[BaseModel]] = [model]
    for key in path:
        if isinstance(key, int):
            continue
        fields = [inner.model_fields[key] for inner in models if key in inner.model_fields]
        models = [inner for field in fields for inner in _models(field.annotation)]
    return fields


def _keys_at(path: tuple, model: type[BaseModel]) -> list[str]:
    models = [inner for field in _fields_at(path, model) for inner in _models(field.annotation)] if path else [model]
    return list(dict.fromkeys(key for inner in models for key in inner.model_fields))


def _allowed_at(path: tuple, model: type[BaseModel]) -> str:
    for field in _fields_at(path, model):
        quantity = quantity_of(field.annotation, field.metadata)
        if quantity:
            return quantity.describe()
    for field in _fields_at(path, model):
        limits = {k: v for m in field.metadata for k in ("ge", "le") if (v := getattr(m, k, None)) is not None}
        if limits:
            words = [f"{sign} {limits[k]}" for k, sign in (("ge", ">="), ("le", "<=")) if k in limits]
            return f"a whole number, {' and '.join(words)}"
    keys = _keys_at(path, model)
    if keys:
        return f"a mapping with the keys {', '.join(keys)}"
    words = [_in_words(field.annotation) for field in _fields_at(path, model)]
    return " or ".join(dict.fromkeys(words)) or "see the documentation, 'A study, key by key'"


def _in_words(annotation: Any) -> str:
    """What a field takes that is neither a quantity nor a block."""
    plain = {str: "text", bool: "true or false", int: "a whole number", float: "a number", Any: "a number, a name or a block"}
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Literal:
        return " or ".join(map(repr, parts))
    if origin in (list, tuple):
        inside = [part for part in parts if part is not ...]
        return "a list of items, each " + " or ".join(dict.fromkeys(map(_in_words, inside)))
    if origin is dict:
        return f"a mapping of key paths, each with {_in_words(parts[1])}"
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return "{" + ", ".join(field.alias or name for name, field in annotation.model_fields.items()) + "}"
    inside = [part for part in parts if part is not type(None)] if parts else []
    return " or ".join(dict.fromkeys(map(_in_words, inside))) if inside else plain.get(annotation, "text")
