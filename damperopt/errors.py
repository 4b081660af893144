"""Exceptions that say what to do next; each carries the exit code of the command line."""

from __future__ import annotations

from typing import Any

__all__ = ["CertificateError", "ConfigError", "DamperoptError", "Interrupted", "OutputError", "Unfinished"]


class DamperoptError(Exception):
    """Base of every error a user can meet; `exit_code` is what the command line returns."""

    exit_code = 4


class ConfigError(DamperoptError):
    """The input is wrong: one message per problem, each ``file:line: key.path: what; allowed``.

    Parameters
    ----------
    problems : list of str
        One line per problem, in the order in which the file shows them.
    """

    exit_code = 2

    def __init__(self, problems: list[str] | str):
        self.problems = [problems] if isinstance(problems, str) else list(problems)
        super().__init__("\n".join(self.problems))


class Interrupted(DamperoptError):
    """The user stopped the run."""

    exit_code = 130


class OutputError(DamperoptError):
    """The results cannot be written where they should go."""

    exit_code = 2


class CertificateError(DamperoptError):
    """The exact certificate cannot be formed for this model (it is never merely 'not stable')."""


class Unfinished(KeyboardInterrupt):
    """The user stopped a search that had something to keep: its `result`."""

    def __init__(self, result: Any):
        self.result = result
        super().__init__("interrupted")
