"""The work at one point of a sweep, in whatever process."""

from __future__ import annotations

import time
import traceback
from collections.abc import Mapping
from typing import Any

import numpy as np

from ..design import optimise
from ..errors import ConfigError
from ..optimum.stock import of_chosen_sizes
from ..provenance import program
from ..stability.critical import critical_speeds
from ..stability.linear import LinearGear, LinearModel, linear_gear
from ..stability.modes import track_modes
from ..stability.over_damping import worst_over_damping
from ..stability.wavelength import shortest_wavelength
from ..study.study import Study

__all__ = ["run_point"]


def run_point(study_json: str, run: str, speeds: int, start: Mapping[str, float] | None = None) -> dict[str, Any]:
    """Optimise or analyse a study; what goes wrong is part of the answer.

    Parameters
    ----------
    study_json : str
        The study.
    run : str
        ``optimise`` or ``analyse``.
    speeds : int
        Over the envelope, at which eigenvalues are kept.
    start : mapping or None
        A neighbour's design [SI], which replaces the study's own start.

    Returns
    -------
    dict
        Plain data: ``status``, ``message``, ``seconds``, ``numbers``, ``result``, ``modes`` with speeds and eigenvalues, and
        ``program``, which found them.
    """
    clock = time.perf_counter()
    try:
        found = (_optimised if run == "optimise" else _analysed)(Study.model_validate_json(study_json), speeds, start)
    except ConfigError as error:
        found = {"status": "invalid", "message": "; ".join(error.problems), "numbers": {}, "result": None, "modes": None}
    except Exception as error:  # a failed point is a record, not a dead sweep
        last = traceback.extract_tb(error.__traceback__)[-1]
        message = f"{type(error).__name__}: {error} ({last.name})"
        found = {"status": "error", "message": message, "numbers": {}, "result": None, "modes": None}
    return found | {"seconds": time.perf_counter() - clock, "program": program()}


def _optimised(study: Study, speeds: int, start: Mapping[str, float] | None) -> dict[str, Any]:
    result = optimise(_started(study, start))
    made = of_chosen_sizes(study, result)
    result = result.model_copy(update={"config": made.model_dump(mode="json")})  # the question as it was put
    numbers = dict(result.design) | {name: value for name, value in result.derived.items() if name not in result.design}
    if result.mass is not None:
        numbers |= {"mass": result.mass.total} | {
            f"mass_{part.replace(' ', '_')}": value for part, value in result.mass.parts.items()
        }
    if result.stability is not None:
        numbers |= {"abscissa": result.stability.abscissa} | _waves(made, linear_gear(made, result.design))
    if result.decay is not None:
        numbers["decay_ratio"] = result.decay.ratio
    modes = _modes(made, result.design, speeds) if result.status == "solved" else None
    return {
        "status": result.status,
        "message": result.message,
        "numbers": {name: float(value) for name, value in numbers.items() if np.isfinite(value)},
        "result": result.model_dump(mode="json"),
        "modes": modes,
    }


def _started(study: Study, start: Mapping[str, float] | None) -> Study:
    """The study with a neighbour's design for a start, where its bounds allow it."""
    try:
        return study.replace(**{f"design__{name}__start": value for name, value in (start or {}).items()})
    except ConfigError:
        return study


def _analysed(study: Study, speeds: int, start: Mapping[str, float] | None) -> dict[str, Any]:
    model = LinearModel(study)
    gear, worst = model.at(study.start), worst_over_damping(model, study, study.start)[0]
    critical = [c.speed for load in study.envelope.loads for c in critical_speeds(gear, load, *_range(study))]
    numbers = {"abscissa": worst.abscissa, "worst_speed": worst.speed, "worst_load": worst.load}
    numbers |= _waves(study, gear)
    numbers |= {"lowest_critical_speed": min(critical, default=np.nan), "highest_critical_speed": max(critical, default=np.nan)}
    margin = study.requirements.stability_margin if study.requirements else 0.0
    stable = worst.abscissa < 0
    kept = stable and worst.abscissa <= -margin
    return {
        "status": "stable" if kept else "margin missed" if stable else "unstable",
        "message": "" if kept else f"spectral abscissa {worst.abscissa:.4g} 1/s at {worst.speed:.4g} m/s, wanted {-margin:g}",
        "numbers": {name: float(value) for name, value in numbers.items() if np.isfinite(value)},
        "result": None,
        "modes": _modes(study, study.start, speeds),
    }


def _waves(study: Study, gear: LinearGear) -> dict[str, float]:
    """The shortest wave of the modes in contact lengths, which says how far a contact line without memory is to be believed."""
    wave = shortest_wavelength(study, gear)
    return {} if wave is None else {"contact_lengths_per_wave": wave.contact_lengths}


def _range(study: Study) -> tuple[float, float]:
    return study.envelope.speed.min, study.envelope.speed.max


def _modes(study: Study, design: Mapping[str, float], speeds: int) -> dict[str, Any]:
    """Eigenvalues over the envelope at its largest load, as lists."""
    table = track_modes(linear_gear(study, design), np.unique(np.linspace(*_range(study), speeds)), max(study.envelope.loads))
    return {
        "speed": table.speeds.tolist(),
        "load": float(table.load),
        "names": list(table.names),
        "real": table.eigenvalues.real.tolist(),
        "imag": table.eigenvalues.imag.tolist(),
    }
