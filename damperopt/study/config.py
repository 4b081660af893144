"""From a YAML file to a `Study`; nothing else reads YAML. Every problem is reported with file, line and key path."""

from __future__ import annotations

import difflib
import re
import reprlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ValidationError

from ..errors import ConfigError
from ..quantities.record import quantity_of
from .study import Study

__all__ = ["json_schema", "load", "loads", "parsed", "text_of"]

Record = TypeVar("Record", bound=BaseModel)


class _Loader(yaml.SafeLoader):
    """YAML with numbers as engineers write them and no duplicate keys."""


# YAML 1.1, as PyYAML reads it, takes 1e5 for text and yes/no for booleans
_Loader.yaml_implicit_resolvers = {
    first: [(tag, rule) for tag, rule in rules if tag not in ("tag:yaml.org,2002:float", "tag:yaml.org,2002:bool")]
    for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver("tag:yaml.org,2002:bool", re.compile(r"^(?:true|false)$"), list("tf"))
_Loader.add_implicit_resolver(
    "tag:yaml.org,2002:float",
    re.compile(r"^[-+]?(?:(?:\d+\.\d*|\.\d+)(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\.(?:inf|Inf|INF))$|^\.(?:nan|NaN|NAN)$"),
    list("-+0123456789."),
)


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


def text_of(path: str | Path) -> str:
    """Text of a file that a user names.

    Raises
    ------
    ConfigError
        If it cannot be read.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as error:
        raise ConfigError(f"{path}: cannot be read: {error.strerror}; allowed: a readable YAML file") from error
    except UnicodeDecodeError as error:
        raise ConfigError(f"{path}: is not UTF-8 text (byte {error.start}); allowed: a YAML text file") from error


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
    loader = None
    try:
        loader = _Loader(text)
        root = loader.get_single_node()
        if not isinstance(root, yaml.MappingNode):
            raise ConfigError(f"{name}:1: the file is not a mapping of keys; allowed: {', '.join(model.model_fields)}")
        lines: dict[tuple, int] = {}
        duplicates = _index(root, (), lines, name)
        if duplicates:
            raise ConfigError(duplicates)
        data = loader.construct_document(root)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        raise ConfigError(f"{name}:{line}: not valid YAML: {error.problem or error.context}") from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ConfigError(f"{name}:1: not valid YAML: {error}") from error
    finally:
        if loader is not None:
            loader.dispose()
    if empty := _empty(root, (), name, model):
        raise ConfigError(empty)
    try:
        return model.model_validate(data), lines
    except ValidationError as error:
        problems = [_message(problem, data, lines, name, model) for problem in error.errors(include_url=False)]
        raise ConfigError([text for _, text in sorted(set(problems))]) from None


def json_schema() -> dict[str, Any]:
    """JSON Schema of a configuration file, for editors."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **Study.model_json_schema()}


def _index(node: yaml.Node, path: tuple, lines: dict[tuple, int], name: str) -> list[str]:
    """Line of every key path below `node`, into `lines`; messages about duplicate keys."""
    lines.setdefault(path, node.start_mark.line + 1)
    problems: list[str] = []
    if isinstance(node, yaml.MappingNode):
        seen: dict[str, int] = {}
        for key_node, value_node in node.value:
            key, line = key_node.value, key_node.start_mark.line + 1
            if not isinstance(key, str):
                problems.append(f"{name}:{line}: {_dotted(path)}: a key is no text; allowed: text keys")
                continue
            if key in seen:
                where = _dotted((*path, key))
                problems.append(f"{name}:{line}: {where}: duplicate key, first on line {seen[key]}; allowed: each key once")
            seen[key] = line
            lines[(*path, key)] = line
            problems += _index(value_node, (*path, key), lines, name)
    elif isinstance(node, yaml.SequenceNode):
        for position, item in enumerate(node.value):
            problems += _index(item, (*path, position), lines, name)
    return problems


def _empty(node: yaml.Node, path: tuple, name: str, model: type[BaseModel]) -> list[str]:
    """Messages about keys with nothing behind them: an empty block would drop a requirement without a word."""
    if isinstance(node, yaml.MappingNode):
        items = [(key.value, value) for key, value in node.value]
    elif isinstance(node, yaml.SequenceNode):
        items = list(enumerate(node.value))
    else:
        if node.tag != "tag:yaml.org,2002:null":
            return []
        allowed = _allowed_at(path, model)
        return [f"{name}:{node.start_mark.line + 1}: {_dotted(path)}: found nothing; allowed: {allowed}; or leave the key out"]
    return [text for key, value in items for text in _empty(value, (*path, key), name, model)]


def _message(problem: Any, data: Any, lines: dict[tuple, int], name: str, model: type[BaseModel]) -> tuple[int, str]:
    context = problem.get("ctx", {})
    path = _path_in_file(problem["loc"], data) + tuple(filter(None, context.get("key", "").split(".")))
    known = path
    while known not in lines:
        known = known[:-1]
    what = _what(problem, path, model)
    return lines[known], f"{name}:{lines[known]}: {_dotted(path)}: {what}"


def _path_in_file(location: Sequence[Any], data: Any) -> tuple:
    """Location without the union tags that pydantic inserts."""
    path: list[Any] = []
    for position, step in enumerate(location):
        inside = isinstance(data, dict) and step in data
        inside = inside or (isinstance(data, list) and isinstance(step, int) and step < len(data))
        if inside:
            data = data[step]
        elif position < len(location) - 1 or not isinstance(step, str) or isinstance(data, (list, str, float, int)):
            continue  # a tag of a union, or a scalar that stands for a list
        elif step[:1].isupper() and step not in ("I_arm", "L"):
            continue  # a tag: the name of a record class
        path.append(step)
    return tuple(path)


def _what(problem: Any, path: tuple, model: type[BaseModel]) -> str:
    kind, context = problem["type"], problem.get("ctx", {})
    if kind in ("quantity", "study"):
        return problem["msg"]
    found = _Shortened(problem.get("input"))
    if kind == "missing":
        return f"missing key; allowed: {_allowed_at(path, model)}"
    if kind == "extra_forbidden":
        siblings = _keys_at(path[:-1], model)
        close = difflib.get_close_matches(str(path[-1]), siblings, n=1)
        hint = f" (did you mean '{close[0]}'?)" if close else ""
        return f"unknown key{hint}; allowed: {', '.join(siblings) or 'none'}"
    if kind == "literal_error":
        return f"{found!r} is not one of the choices; allowed: {context['expected']}"
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        tags = "'nonlinear', 'linear', 'straight_tangent'"
        return f"{'missing' if kind.endswith('found') else repr(context.get('tag'))} tyre law; allowed: law: {tags}"
    if kind.startswith("model_") or kind in ("dict_type", "model_type"):
        return f"found {found!r} instead of a block; allowed: a mapping with the keys {', '.join(_keys_at(path, model))}"
    if kind == "list_type":
        return f"found {found!r} instead of a list; allowed: a list of items, each {_allowed_at(path, model)}"
    return f"found {found!r}; {problem['msg'][0].lower()}{problem['msg'][1:]}; allowed: {_allowed_at(path, model)}"


class _Shortened:
    """Value whose repr fits into a message."""

    def __init__(self, value: Any):
        self.value = value

    def __repr__(self) -> str:
        return reprlib.repr(self.value)

    __str__ = __repr__


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
    return f"a mapping with the keys {', '.join(keys)}" if keys else "see 'damperopt init' for an example"


def _dotted(path: tuple) -> str:
    return ".".join(str(key) for key in path) or "(file)"
