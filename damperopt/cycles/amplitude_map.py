"""The largest stable limit cycle over two parameters: a branch over the first for each value of the second."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from ..charts.plane import Axis
from .branches import Question, from_hopf_points
from .elements import joints_of
from .orbit import Branch

__all__ = ["AmplitudeMap", "amplitude_map", "largest_stable", "unknown"]

COLUMNS = 60
"""Values of the first parameter."""


@dataclass(frozen=True)
class AmplitudeMap:
    """Amplitudes of yaw of the largest stable limit cycles that grow out of Hopf points.

    Attributes
    ----------
    x, y : Axis
    columns, rows : ndarray
        (m,), (k,) values of both [SI].
    yaw : ndarray
        (k, m) amplitude [rad]; 0 where no stable cycle is found.
    lost : ndarray
        (k, m) whether larger ones may be missing: a branch of this row was lost, or rest is unstable and no branch arrives.
    """

    x: Axis
    y: Axis
    columns: np.ndarray
    rows: np.ndarray
    yaw: np.ndarray
    lost: np.ndarray


def amplitude_map(
    question: Question, second: Axis, count: int, report: Callable[[int], None] = lambda row: None
) -> AmplitudeMap:
    """Branches over `question.axis` for `count` values of a second quantity.

    Parameters
    ----------
    question : Question
    second : Axis
    count : int
    report : callable
        Called with the number of each finished row.
    """
    columns = np.linspace(question.axis.low, question.axis.high, COLUMNS)
    rows = np.linspace(second.low, second.high, count)
    yaw, lost = np.zeros((count, COLUMNS)), np.zeros((count, COLUMNS), bool)
    for k, value in enumerate(rows):
        there = question.at(second.name, float(value))
        branches = from_hopf_points(there)
        yaw[k] = largest_stable(branches, columns)
        lost[k] = any(branch.lost for branch in branches)
        lost[k] |= (yaw[k] == 0) & ~there.rest_is_stable(columns)
        report(k)
    return AmplitudeMap(question.axis, second, columns, rows, yaw, lost)


def largest_stable(branches: Sequence[Branch], values: Sequence[float] | np.ndarray, quantity: str = "yaw_angle") -> np.ndarray:
    """Amplitude of the largest stable cycle at values of the parameter, between neighbours of a branch by straight lines.

    Parameters
    ----------
    branches : sequence of Branch
    values : sequence of float
        (m,) [SI]
    quantity : str

    Returns
    -------
    ndarray
        (m,) [SI]; 0 where none is stable.
    """
    values = np.asarray(values, float)
    found = np.zeros(len(values))
    for branch in branches:
        for left, right in pairwise(branch.orbits):
            if not (left.stable or left.label) or not (right.stable or right.label) or not (left.stable or right.stable):
                continue
            ends = sorted([(left.parameter, left.amplitudes[quantity]), (right.parameter, right.amplitudes[quantity])])
            inside = (values >= ends[0][0]) & (values <= ends[1][0])
            (p, low), (q, high) = ends
            found[inside] = np.maximum(found[inside], np.interp(values[inside], [p, q], [low, high]))
    return found


def unknown(question: Question, branches: Sequence[Branch], begin: str, left: Sequence[str]) -> list[str]:
    """Why a search cannot say that there are no larger cycles, in words; empty where nothing speaks against it.

    Parameters
    ----------
    question : Question
    branches : sequence of Branch
    begin : str
        ``hopf`` or ``simulation``.
    left : sequence of str
        Motions that left the range of the model.
    """
    words = [f"{sum(branch.lost for branch in branches)} branches were lost"] * any(branch.lost for branch in branches)
    words += [f"{len(left)} motions left the range of the model"] * bool(left)
    if begin == "hopf":
        if joints := joints_of(question.study):
            words.append(f"the joints were closed ({', '.join(joints)}): --from simulation has them")
        columns = np.linspace(question.axis.low, question.axis.high, COLUMNS)
        if ((largest_stable(branches, columns) == 0) & ~question.rest_is_stable(columns)).any():
            words.append("rest is unstable where no stable cycle was found")
    return words
