"""The gear with its actuator off, which has a margin of its own: further places of the same problem.

A place is a speed, a load and a factor on the damping; a factor below 0 stands for its size with the actuator off. Abscissae
there are moved by what that margin differs from the other, so that one limit serves all places.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from ..results import OperatingPoint
from ..study.study import Study
from .linear import LinearModel
from .over_damping import worst_over_damping

__all__ = ["FailSafe"]


class FailSafe:
    """A study with an actuator whose gains are 0, state for state as with it.

    Parameters
    ----------
    study : Study
        With an actuator and requirements.

    Attributes
    ----------
    model : LinearModel
    less : float
        By how much its margin is larger than that with the actuator on [1/s]; mostly negative.
    """

    def __init__(self, study: Study):
        self.study = study.replace(damper__control__gains={name: {} for name in study.damper.control.gains})
        self.model = LinearModel(self.study)
        self.less = study.fail_safe_margin - study.required.stability_margin

    def worst_points(self, design: Mapping[str, float], enough: float = math.inf) -> list[OperatingPoint]:
        """As `worst_over_damping` has them, as places with the actuator off."""
        found = worst_over_damping(self.model, self.study, design, enough - self.less)
        return [replace(point, abscissa=point.abscissa + self.less, damping=-point.damping) for point in found]
