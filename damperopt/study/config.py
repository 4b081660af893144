"""From a YAML file to a `Study`; nothing else reads YAML. Every problem is reported with file, line and key path."""

from __future__ import annotations

import copy
import difflib
import logging
import types
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from ..errors import ConfigError
from ..quantities.record import quantity_of
from ..reading import printable, quoted, text_of
from ..tyres.property_file import block_of_file
from . import schema
from .components import gears
from .document import dotted, few, read
from .study import Study

__all__ = ["files_of", "is_sweep", "json_schema", "load", "loads", "parsed", "text_of"]

logger = logging.getLogger("damperopt")

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


def files_of(path: str | Path) -> list[str]:
    """Files that a study names and that are read with it, as it names them."""
    data = read(text_of(path), str(path), "the keys of a study").data
    tyre = data.get("tyre")
    named = [tyre.get("file") if isinstance(tyre, dict) else None, data.get("catalogue")]
    return [name for name in named if isinstance(name, str)]


def is_sweep(text: str, name: str) -> bool:
    """Whether a text describes a sweep: a base that is varied."""
    return _describes_a_sweep(read(text, name, "the keys of a study, or of a sweep").data)


def _describes_a_sweep(data: dict[str, Any]) -> bool:
    return "base" in data and not {"gear", "tyre", "damper"} & set(data)


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
    if model is Study and _describes_a_sweep(data):
        raise ConfigError(
            f"{name}:{lines[('base',)]}: base: this is a sweep, not a study; allowed: a study here, or 'damperopt sweep'"
        )
    if document.empty:
        # an empty block would drop a requirement without a word
        raise ConfigError([
            f"{name}:{lines[path]}: {dotted(path)}: found nothing; allowed: {_allowed_at(path, model)}; or leave the key out"
            for path in document.empty
        ])  # fmt: skip
    if model is Study:
        data = _with_files(data, lines, name)
    try:
        return model.model_validate(data, context={"folder": Path(name).parent}), lines
    except ValidationError as error:
        found = _without_other_branches(error.errors(include_url=False))
        problems = [_message(problem, data, lines, name, model) for problem in found]
        raise ConfigError(few([text for _, text in sorted(set(problems))])) from None


def _with_files(data: dict[str, Any], lines: Mapping[tuple, int], name: str) -> dict[str, Any]:
    """The data of a study with what the files hold that it names, beside it."""
    tyre = data.get("tyre")
    if not (isinstance(tyre, dict) and "file" in tyre):
        return data
    block, found = block_of_file(tyre, Path(name).parent, f"{name}:{lines['tyre', 'file']}: tyre.file")
    if found.newer:
        logger.warning("%s: %s: %s", printable(found.name), found.kind, "; ".join(found.notes))
    return data | {"tyre": block}


def _without_other_branches(problems: Sequence[Any]) -> list[Any]:
    """Without 'no list' where a block was meant and has problems of its own, and the like."""

    def other(problem: Any) -> bool:
        *start, _ = problem["loc"] or ("",)
        deeper = (found["loc"] for found in problems if len(found["loc"]) > len(problem["loc"]))
        return problem["type"] in ("list_type", "model_type", "dict_type") and any(
            list(loc[: len(start)]) == start for loc in deeper
        )

    return [problem for problem in problems if not other(problem)]


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
    _tyres_without_law(found)
    return found


def _tyres_without_law(found: dict[str, Any]) -> None:
    """A size, or a property file, says what law a tyre has."""
    blocks = found["$defs"]
    blocks["TR_R64LawTyre"]["required"].remove("law")
    of_file = copy.deepcopy(blocks["MagicFormulaLawTyre"])
    del of_file["properties"]["coefficients"], of_file["properties"]["source"]
    words = "Property file (.tir) of the tyre, beside the study: Magic Formula, or Fiala and UA."
    of_file["properties"] |= {"file": {"type": "string", "description": words}, "law": {"type": "string", "description": words}}
    of_file |= {"title": "TyreOfFile", "description": words, "required": ["file", "half_contact_length"]}
    blocks["TyreOfFile"] = of_file
    found["properties"]["tyre"]["oneOf"].append({"$ref": "#/$defs/TyreOfFile"})


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
        if path[-1] in siblings:
            return "belongs to another kind of this block; allowed: the keys of the kind that the block names"
        close = difflib.get_close_matches(str(path[-1]), siblings, n=1)
        hint = f" (did you mean '{close[0]}'?)" if close else ""
        return f"unknown key{hint}; allowed: {', '.join(siblings) or 'none'}"
    if kind == "literal_error":
        return f"{found} is not one of the choices; allowed: {context['expected']}"
    if kind in ("union_tag_invalid", "union_tag_not_found") and not isinstance(problem.get("input"), dict):
        return f"found {found} instead of a block; allowed: {_allowed_at(path, model)}"
    if kind.startswith("model_") or kind == "dict_type":
        return f"found {found} instead of a block; allowed: {_allowed_at(path, model)}"
    if kind == "list_type":
        return f"found {found} instead of a list; allowed: {_allowed_at(path, model)}"
    if kind == "value_error":
        return problem["msg"].removeprefix("Value error, ")
    return f"found {found}; {problem['msg'][0].lower()}{problem['msg'][1:]}; allowed: {_allowed_at(path, model)}"


def _models(annotation: Any) -> list[type[BaseModel]]:
    """Record classes that an annotation may stand for; those behind the keys of a mapping are not."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is dict:
        return []
    return [model for part in getattr(annotation, "__args__", ()) for model in _models(part)]


def _types_at(path: tuple, model: type[BaseModel]) -> list[Any]:
    """Types that may stand at a key path, with what limits them."""
    found: list[Any] = [model]
    for key in path:
        found = [inner for annotation in found for inner in _types_behind(key, annotation)]
    return found


def _types_behind(key: Any, annotation: Any) -> list[Any]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        fields = [field for name, field in annotation.model_fields.items() if key in (name, field.alias)]
        return [Annotated[(field.annotation, *field.metadata)] if field.metadata else field.annotation for field in fields]
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is dict:
        return [parts[1]]
    if origin in (list, tuple) and isinstance(key, int):
        return [parts[min(key, len(parts) - 1)]]
    return [inner for part in getattr(annotation, "__args__", ()) for inner in _types_behind(key, part)]


def _keys_at(path: tuple, model: type[BaseModel]) -> list[str]:
    models = [inner for annotation in _types_at(path, model) for inner in _models(annotation)]
    return list(dict.fromkeys(field.alias or key for inner in models for key, field in inner.model_fields.items()))


def _allowed_at(path: tuple, model: type[BaseModel]) -> str:
    behind = _types_at(path, model)
    for annotation in behind:
        quantity = quantity_of(annotation)
        if quantity:
            return quantity.describe()
    for annotation in behind:
        limits = {k: v for m in _notes(annotation) for k in ("ge", "le") if (v := getattr(m, k, None)) is not None}
        if limits:
            words = [f"{sign} {limits[k]}" for k, sign in (("ge", ">="), ("le", "<=")) if k in limits]
            return f"a whole number, {' and '.join(words)}"
    keys = _keys_at(path, model)
    words = [f"a mapping with the keys {', '.join(keys)}"] if keys else []
    others = [part for annotation in behind for part in _parts(annotation) if not (keys and _models(part))]
    words += [_in_words(part) for part in others]
    return " or ".join(dict.fromkeys(words)) or "see the documentation, 'A study, key by key'"


def _notes(annotation: Any) -> list[Any]:
    """What limits a number, however deep pydantic packs it."""
    notes = list(getattr(annotation, "__metadata__", ()))
    return notes + [note for outer in notes for note in getattr(outer, "metadata", ())]


def _parts(annotation: Any) -> list[Any]:
    """What a union is made of."""
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _parts(parts[0])
    if origin in (Union, types.UnionType):
        return [inner for part in parts if part is not type(None) for inner in _parts(part)]
    return [annotation]


def _in_words(annotation: Any) -> str:
    """What a field takes that is neither a quantity nor a block."""
    plain = {str: "text", bool: "true or false", int: "a whole number", float: "a number", Any: "a value"}
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _in_words(parts[0])
    if origin is Literal:
        return " or ".join(map(repr, parts))
    if origin in (list, tuple):
        inside = [_in_words(part) for part in parts if part not in (..., Any)]
        return "a list" + (f", each item {' or '.join(dict.fromkeys(inside))}" if inside else "")
    if origin is dict:
        return f"a mapping of key paths, each with {_in_words(parts[1])}"
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return "{" + ", ".join(field.alias or name for name, field in annotation.model_fields.items()) + "}"
    inside = [part for part in parts if part is not type(None)]
    return " or ".join(dict.fromkeys(map(_in_words, inside))) if inside else plain.get(annotation, "text")
