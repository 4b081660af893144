"""YAML text as plain data, with the line of every key; what two readers of YAML would read differently is refused."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any

import yaml

from ..errors import ConfigError
from ..quantities.units import underflows
from ..reading import code_point, printable, quoted, unprintable

__all__ = ["Document", "dotted", "few", "read"]

DEEPEST = 32
MOST_PROBLEMS = 30
MOST_VALUES = 100_000
LONGEST_TEXT = 1000
LONGEST_NUMBER = 60

_TAG = "tag:yaml.org,2002:"
_NUMBER = r"(?:0|[1-9][0-9]*)"


class _Loader(yaml.SafeLoader):
    """Numbers as engineers write them; no tags, and no deeper than `DEEPEST`."""

    depth = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        event = self.peek_event()
        if getattr(event, "tag", None) is not None:
            raise yaml.composer.ComposerError(
                None, None, f"the tag {quoted(event.tag)}; allowed: values without a tag", event.start_mark
            )
        self.depth += 1
        if self.depth > DEEPEST:
            raise yaml.composer.ComposerError(None, None, f"blocks more than {DEEPEST} deep", event.start_mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


# Of the implicit tags of YAML 1.1 none that other readers understand otherwise: 010 is 8, 1:30 is 90, 0x10 is 16 and yes
# is true to some of them only, and 1e5 is text. Here all of these are text, and no number.
_Loader.yaml_implicit_resolvers = {
    first: [(tag, rule) for tag, rule in rules if tag in (_TAG + "null", _TAG + "merge")]
    for first, rules in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_Loader.add_implicit_resolver(_TAG + "bool", re.compile(r"^(?:true|false)$"), list("tf"))
_Loader.add_implicit_resolver(_TAG + "int", re.compile(rf"^[-+]?{_NUMBER}$"), list("-+0123456789"))
_Loader.add_implicit_resolver(
    _TAG + "float",
    re.compile(
        rf"^[-+]?(?:(?:{_NUMBER}\.[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?|{_NUMBER}[eE][-+]?[0-9]+|\.(?:inf|Inf|INF))$"
        r"|^\.(?:nan|NaN|NAN)$"
    ),
    list("-+0123456789."),
)


@dataclass
class Document:
    """A mapping read from YAML.

    Attributes
    ----------
    data : dict
    lines : dict of tuple to int
        Line of every key path.
    empty : list of tuple
        Key paths with nothing behind them.
    """

    data: dict[str, Any] = field(default_factory=dict)
    lines: dict[tuple, int] = field(default_factory=dict)
    empty: list[tuple] = field(default_factory=list)


def dotted(path: tuple) -> str:
    """Key path as a message shows it."""
    return ".".join(quoted(key) if key == "" or len(str(key)) > 60 else printable(key) for key in path) or "(file)"


def read(text: str, name: str, allowed: str) -> Document:
    """Data and lines of a YAML text.

    Parameters
    ----------
    text : str
    name : str
        Name of the source, for messages.
    allowed : str
        Keys at the top, for messages.

    Returns
    -------
    Document

    Raises
    ------
    ConfigError
        With one message per problem, each with the line.
    """
    name, loader = printable(name), None
    try:
        loader = _Loader(text)
        root = loader.get_single_node()
        if not isinstance(root, yaml.MappingNode):
            raise ConfigError(f"{name}:1: the file is not a mapping of keys; allowed: {allowed}")
        walk = _Walk(name)
        walk.visit(root, ())
        if walk.problems:
            raise ConfigError(few(walk.problems))
        return Document(loader.construct_document(root), walk.lines, walk.empty)
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 1
        raise ConfigError(f"{name}:{line}: not valid YAML: {printable(error.problem or error.context)}") from error
    except yaml.reader.ReaderError as error:
        line = text.count("\n", 0, error.position) + 1
        raise ConfigError(
            f"{name}:{line}: not valid YAML: the character {code_point(error.character)}; allowed: printable text"
        ) from error
    except RecursionError as error:
        raise ConfigError(f"{name}:1: not valid YAML: blocks inside themselves") from error
    except (yaml.YAMLError, ValueError) as error:
        raise ConfigError(f"{name}:1: not valid YAML: {printable(error)}") from error
    finally:
        if loader is not None:
            loader.dispose()


class _Walk:
    """Lines of every key path below a node, and what is wrong with keys and values as text."""

    def __init__(self, name: str):
        self.name = name
        self.lines: dict[tuple, int] = {}
        self.empty: list[tuple] = []
        self.problems: list[str] = []
        self.values = 0

    def visit(self, node: yaml.Node, path: tuple) -> None:
        line = node.start_mark.line + 1
        self.values += 1  # those behind an alias count each time: a few lines can stand for billions
        if self.values > MOST_VALUES or len(path) > DEEPEST:
            limit = f"{MOST_VALUES} values" if self.values > MOST_VALUES else f"{DEEPEST} levels"
            raise ConfigError(f"{self.name}:{line}: {dotted(path[:4])}: more than {limit}, those behind aliases included")
        self.lines.setdefault(path, line)
        if isinstance(node, yaml.MappingNode):
            self.mapping(node, path, {})
        elif isinstance(node, yaml.SequenceNode):
            for position, item in enumerate(node.value):
                self.visit(item, (*path, position))
        else:
            self.scalar(node, path, line)

    def mapping(self, node: yaml.MappingNode, path: tuple, seen: dict[str, int]) -> None:
        for key_node, value_node in node.value:
            line = key_node.start_mark.line + 1
            if key_node.tag == _TAG + "merge":
                self.merge(value_node, path, seen, line)
                continue
            if not isinstance(key_node, yaml.ScalarNode) or key_node.tag != _TAG + "str":
                found = quoted(key_node.value) if isinstance(key_node, yaml.ScalarNode) else "a list or a mapping"
                self.say(line, path, f"the key {found} is no text; allowed: text keys")
                continue
            key = key_node.value
            if words := _unfit(key):
                self.say(line, path, f"a key with {words}; allowed: printable text")
                continue
            if key in seen:
                self.say(line, (*path, key), f"duplicate key, first on line {seen[key]}; allowed: each key once")
            seen[key] = line
            self.lines[(*path, key)] = line
            self.visit(value_node, (*path, key))

    def merge(self, node: yaml.Node, path: tuple, seen: dict[str, int], line: int) -> None:
        """Keys of ``<<`` are keys like others: one that is given twice would be overridden without a word."""
        for part in node.value if isinstance(node, yaml.SequenceNode) else [node]:
            if isinstance(part, yaml.MappingNode):
                self.mapping(part, path, seen)
            else:
                self.say(line, path, "'<<' without a block; allowed: an alias of a block")

    def scalar(self, node: yaml.ScalarNode, path: tuple, line: int) -> None:
        if node.tag == _TAG + "null":
            self.empty.append(path)
        elif node.tag in (_TAG + "int", _TAG + "float"):
            if len(node.value) > LONGEST_NUMBER:
                self.say(line, path, f"a number of {len(node.value)} characters; allowed: at most {LONGEST_NUMBER}")
            elif re.match("[-+.]*[0-9]", node.value) and underflows(node.value):
                self.say(line, path, f"{quoted(node.value)} is too small for a number and would become 0; allowed: 0, or more")
        elif node.tag == _TAG + "merge":
            self.say(line, path, "'<<' is no value; allowed: it stands before a block that is merged")
        elif words := _unfit(node.value):
            self.say(line, path, f"text with {words}; allowed: printable text")

    def say(self, line: int, path: tuple, what: str) -> None:
        self.problems.append(f"{self.name}:{line}: {dotted(path)}: {what}")


def _unfit(text: str) -> str:
    """Why text can be no name and no value, in words; empty if it can."""
    if len(text) > LONGEST_TEXT:
        return f"{len(text)} characters (at most {LONGEST_TEXT})"
    return unprintable(text)


def few(problems: list[str]) -> list[str]:
    """The first problems of a file; those behind them are often the same."""
    rest = len(problems) - MOST_PROBLEMS
    return problems if rest <= 0 else [*problems[:MOST_PROBLEMS], f"... and {rest} problems more"]
