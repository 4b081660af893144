"""What a result claims, checked again from the study and the numbers of the result alone."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..errors import CertificateError, ConfigError
from ..results import DesignResult
from ..stability.linear import LinearModel
from ..study.passive_rest import passive_rest
from ..study.study import Study
from .certify import certify
from .check import check_damping, check_decay, check_grid
from .lightness import Lightness
from .optimality import check_bound

__all__ = ["Finding", "check_again"]

SAME = 1e-9
"""Relative: a mass that is computed again."""

MET = 1e-6
"""Logarithm of a ratio of a requirement that is met to the tolerance of the program."""

BOUND = 1e-12
"""Relative: rounding of a bound that is computed again."""


@dataclass(frozen=True)
class Finding:
    """A claim, whether it holds, and what was found."""

    claim: str
    holds: bool
    words: str


def check_again(study: Study, result: DesignResult, tree: Mapping[str, Any] | None) -> Iterator[Finding]:
    """Each claim of a result on a study.

    Parameters
    ----------
    study : Study
    result : DesignResult
    tree : mapping or None
        Certificate of its lower bound.

    Yields
    ------
    Finding
    """
    if result.mass is None:
        yield Finding("design", False, f"the result has no design: {result.message}")
        return
    steps: list[tuple[str, Callable[[], tuple[bool, str]]]] = [
        ("stability", lambda: _stability(study, result)),
        ("mass and requirements", lambda: _mass(study, result)),
    ]
    if (rest := passive_rest(study)) is not None:
        steps.insert(1, ("stability with the actuator off", lambda: _off(rest, result)))
    if study.required.decay is not None:
        steps.append(("decay", lambda: _decay(study, result)))
    steps.append(("lower bound", lambda: _bound(study, result, tree)))
    for claim, step in steps:
        try:
            yield Finding(claim, *step())
        except (CertificateError, ConfigError, KeyError, ValueError, IndexError, TypeError) as error:
            yield Finding(claim, False, f"cannot be checked: {error}")


def _stability(study: Study, result: DesignResult) -> tuple[bool, str]:
    model = LinearModel(study)
    proof = certify(study, result.design, model=model)
    if not proof.proved:
        return False, proof.reason
    grid = check_grid(study, result.design, model=model)
    if not grid.passed:
        return False, f"an eigenvalue has the real part {grid.worst.abscissa:.6g} 1/s"
    if study.required.damping_ratio is not None:
        least = check_damping(study, result.design, model)[0]
        if least < study.required.damping_ratio:
            return False, f"the yaw mode has the damping ratio {least:.5g}"
    return True, f"{proof.reason}; eigenvalues on {grid.speeds} x {grid.loads} points: worst {grid.worst.abscissa:.6g} 1/s"


def _off(rest: Study, result: DesignResult) -> tuple[bool, str]:
    proof = certify(rest, result.design)
    return proof.proved, f"margin {proof.margin:g} 1/s: {proof.reason}"


def _decay(study: Study, result: DesignResult) -> tuple[bool, str]:
    found = check_decay(study, result.design)
    return found.passed, f"{found.ratio:.5f} of the first amplitude at {found.speed:.4g} m/s, required {found.limit:.5f}"


def _mass(study: Study, result: DesignResult) -> tuple[bool, str]:
    assert result.mass is not None
    light = Lightness(study)
    values = light.function(light.vector(result.design | result.derived | result.limit_event)).full().ravel()
    rows = len(light.rows)
    mass, numbers = float(values[0]), np.log(values[1 + rows :])
    ratios = dict(zip(light.rows, values[1 : 1 + rows], strict=True))
    if not math.isclose(mass, result.mass.total, rel_tol=SAME):
        return False, f"the design weighs {mass:.9g} kg, the result says {result.mass.total:.9g}"
    if not math.isclose(sum(result.mass.parts.values()), mass, rel_tol=SAME):
        return False, f"the parts weigh {sum(result.mass.parts.values()):.9g} kg, all of them {mass:.9g}"
    if "release" in ratios and ratios.pop("release") * math.exp(light.peak(numbers, numbers)) > math.exp(MET):
        return False, f"the damper carries more than {result.limit_event['damper_force']:.6g} N when it is let go"
    missed = [name for name, ratio in ratios.items() if not ratio <= math.exp(MET)]
    if missed:
        return False, f"{missed[0]} is not met"
    return True, f"{mass:.6g} kg; {len(light.rows)} requirements of strength, strokes and lengths"


def _bound(study: Study, result: DesignResult, tree: Mapping[str, Any] | None) -> tuple[bool, str]:
    claimed = result.bound
    if claimed is None or claimed.mass is None:
        return True, "none is claimed"
    if tree is None:
        return False, "its certificate is missing"
    assert result.mass is not None
    found = check_bound(study, tree)
    if found.bound is None:
        return False, found.reason
    if claimed.mass > found.bound * (1 + BOUND):
        return False, f"the certificate proves {found.bound:.9g} kg, the result says {claimed.mass:.9g}"
    gap = 1 - claimed.mass / result.mass.total
    if claimed.gap is None or not math.isclose(gap, claimed.gap, rel_tol=SAME, abs_tol=SAME):
        return False, f"the gap is {gap:.9g}, the result says {claimed.gap}"
    if (claimed.heavier, claimed.shimmies) != (found.heavier, found.shimmies):
        return (
            False,
            f"the certificate has {found.heavier} and {found.shimmies} boxes, not {claimed.heavier} and {claimed.shimmies}",
        )
    return True, f"{found.bound:.6g} kg, {100 * gap:.2g} % below the design: {found.heavier + found.shimmies} boxes"
