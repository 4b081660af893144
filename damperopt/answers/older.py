"""Results of schema version 1 as what they were: rigid parts, a tyre on its leading point, its moment as the only load."""

from __future__ import annotations

from typing import Any

__all__ = ["completed"]

_AS_IT_WAS: dict[str, Any] = {
    "damper.geometry": "planar",
    "damper.compliance": "rigid",
    "tyre.contact": "leading_point",
    "loads.cases": ["tyre_moment"],
    "requirements.ultimate_factor": 1.0,
}
"""Keys that version 1 did not have, or not always, by what it took in their place."""


def completed(data: dict[str, Any]) -> dict[str, Any]:
    """A result of version 1 as one of version 2, with the keys of its study that it does not hold.

    Parameters
    ----------
    data : dict
        As it was read; nothing of it is changed.

    Returns
    -------
    dict
        Its key ``completed`` says as what it is read.
    """
    config, certificate = data.get("config"), data.get("certificate")
    words = "a result of schema version 1"
    if isinstance(config, dict):
        config, values = _with_keys(config)
        words += ", read with " + ", ".join(f"{key} {_in_words(value)}" for key, value in values.items())
    verdict = _verdict(certificate) if isinstance(certificate, dict) else "undecided"
    return {**data, "schema_version": 2, "config": config, "verdict": verdict, "completed": [words]}


def _verdict(certificate: dict[str, Any]) -> str:
    if certificate.get("proved") is True:
        return "proved"
    return "undecided" if certificate.get("counterexample") is None else "refuted"


def _with_keys(config: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """The study with what it lacks, and what these keys are now."""
    config, values = dict(config), {}
    for path, value in _AS_IT_WAS.items():
        block, key = path.split(".")
        found = config.get(block, {} if block == "loads" else None)
        if isinstance(found, dict):
            values[path] = value if found.get(key) is None else found[key]
            config[block] = {**found, key: values[path]}
    return config, values


def _in_words(value: Any) -> str:
    if isinstance(value, dict):  # a block with its tag
        value = next(iter(value.values()), "")
    return ", ".join(map(str, value)) if isinstance(value, list) else f"{value:g}" if isinstance(value, float) else str(value)
