"""JSON Schema of the files, for editors: every key with what it means, its unit and what is allowed."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Iterator
from functools import cache
from itertools import pairwise
from typing import Any

from pydantic import BaseModel

__all__ = ["json_schema", "meanings"]

DRAFT = "https://json-schema.org/draft/2020-12/schema"


def json_schema(model: type[BaseModel]) -> dict[str, Any]:
    """JSON Schema of a file.

    Parameters
    ----------
    model : type
        Class of the record that the file holds.

    Returns
    -------
    dict
    """
    schema = model.model_json_schema()
    blocks = schema.get("$defs", {})
    classes = {kind.__name__: kind for kind in _classes(model, set())}
    for block in (schema, *blocks.values()):
        for part in (block, *block.get("anyOf", ())):
            kind = classes.get(part.get("title", ""))
            for key, described in part.get("properties", {}).items():
                meaning = _meaning(kind, key) if kind is not None else ""
                _describe(described, meaning or _of_the_block(described, part, blocks))
    _without_nothing(schema)
    return {"$schema": DRAFT, **schema}


def _meaning(kind: type[BaseModel], key: str) -> str:
    """Of a key, which may be the alias of a field."""
    name = next((name for name, field in kind.model_fields.items() if field.alias == key), key)
    return meanings(kind).get(name, "")


def _of_the_block(described: dict[str, Any], around: dict[str, Any], blocks: dict[str, Any]) -> str:
    """What a key means by what it names: the block behind it, or the kind that its only value stands for."""
    named = [part["$ref"].rpartition("/")[2] for part in (described, *described.get("anyOf", ())) if "$ref" in part]
    block = blocks[named[0]] if named else {}
    words = next((part["description"] for part in (block, *block.get("anyOf", ())) if "description" in part), "")
    if not words and ("const" in described or "enum" in described):
        words = around.get("description", "")
    return str(words).partition("\n")[0]


def _classes(annotation: Any, seen: set[type]) -> Iterator[type[BaseModel]]:
    """Record classes below an annotation, each once."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        if annotation not in seen:
            seen.add(annotation)
            yield annotation
            for field in annotation.model_fields.values():
                yield from _classes(field.annotation, seen)
        return
    for part in getattr(annotation, "__args__", ()):
        yield from _classes(part, seen)


@cache
def meanings(kind: type[BaseModel]) -> dict[str, str]:
    """What the fields of a record mean, as the text below each of them says; base classes included.

    Parameters
    ----------
    kind : type

    Returns
    -------
    dict of str to str
        By name; without the fields that say nothing.
    """
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        if not (issubclass(base, BaseModel) and base is not BaseModel):
            continue
        try:
            (body,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
        except (OSError, TypeError, SyntaxError, ValueError):  # made at run time: its bases say what its fields mean
            continue
        statements = getattr(body, "body", [])
        for field, text in pairwise(statements):
            match field, text:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(words))):
                    found[name] = inspect.cleandoc(words).replace("`", "")
    return found


def _describe(described: dict[str, Any], meaning: str) -> None:
    """The meaning of a key, and what a number may be, where an editor shows them."""
    parts = [
        described,
        *described.get("anyOf", ()),
        *([described["items"]] if isinstance(described.get("items"), dict) else []),
    ]
    allowed = next((part["$comment"] for part in parts if "$comment" in part), "")
    text = "\n".join(filter(None, [meaning, allowed]))
    if text:
        described["description"] = text


def _without_nothing(schema: Any) -> None:
    """Without the null of optional keys: a file leaves such a key out, and nothing behind it is refused."""
    if isinstance(schema, dict):
        schema.pop("$comment", None)
        if schema.get("default", "") is None:
            del schema["default"]
        options = schema.get("anyOf")
        if isinstance(options, list):
            schema["anyOf"] = [option for option in options if option != {"type": "null"}]
            if len(schema["anyOf"]) == 1:
                (only,) = schema.pop("anyOf")
                schema.update({key: value for key, value in only.items() if key not in schema})
        for part in schema.values():
            _without_nothing(part)
    elif isinstance(schema, list):
        for part in schema:
            _without_nothing(part)
