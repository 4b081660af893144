"""Entries of a structure that change with the load, as numbers of their own: a shock strut moves the gear under its load.

Where the stroke follows the load, the system [[A, B], [C, 0]] is no polynomial in F_z. Its entries that hang on the load are
then further variables of D, one for each power of V in them, with balls over an interval of loads for their values and for
their slopes: D_F follows by the chain rule, and the mean value form of a box stays one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import SimpleNamespace
from typing import Any, TypeAlias

import casadi as ca
import flint

from ..stability.linear import LinearModel
from ..stability.response import FOOTPRINT
from .balls import enclosed
from .parts import inverse_of_powers, samples

__all__ = ["Varying", "structure_of"]

Q: TypeAlias = flint.fmpq


class Varying:
    """Entries of a system that hang on the load.

    Parameters
    ----------
    system : casadi.Function
        (design, speed, load, data) -> matrix.
    design : mapping of str to float
        Design variables by name [SI], in the order of the function's.
    powers : sequence of int
        Of V that the components declare.
    speeds : tuple of fmpq
        Ends of the envelope [m/s].

    Attributes
    ----------
    places : list of tuple of int
        Row and column of each.
    keys : list of tuple of int
        (i, row, column) of each variable: of V^i in that entry.
    """

    def __init__(self, system: ca.Function, design: Mapping[str, float], powers: Sequence[int], speeds: tuple[Q, Q]):
        values, rows = ca.DM(list(design.values())), system.size1_out(0)
        V, load, data = ca.SX.sym("V"), ca.SX.sym("load"), ca.SX.sym("data", system.numel_in(3))
        entries = ca.vec(system(values, V, load, data))
        hang_on = [set(ca.jacobian(entries, of).sparsity().get_triplet()[0]) for of in (load, V)]
        found = sorted(hang_on[0])
        self.places = [(k % rows, k // rows) for k in found]
        self._rolling = [k in hang_on[1] for k in found]
        self._inverse, self._at = inverse_of_powers(powers, speeds), samples(powers, speeds)
        self._zero = list(powers).index(0)
        self.keys = [
            (i, *place) for place, rolls in zip(self.places, self._rolling, strict=True) for i in (powers if rolls else (0,))
        ]
        of_load = ca.vertcat(ca.SX(0, 1), *(ca.substitute(entries[found], V, float(at)) for at in self._at))
        self._values = ca.Function("values", [load, data], [ca.densify(of_load)])
        self._slopes = ca.Function("slopes", [load, data], [ca.densify(ca.jacobian(of_load, load))])

    def values(self, load: flint.arb, data: Sequence[flint.arb]) -> list[flint.arb]:
        """Balls over the variables on a ball of loads [N], in the order of `keys`."""
        return self._in_powers(enclosed(self._values, [[load], data]))

    def slopes(self, load: flint.arb, data: Sequence[flint.arb]) -> list[flint.arb]:
        """The same of their derivatives to the load."""
        return self._in_powers(enclosed(self._slopes, [[load], data]))

    def _in_powers(self, sampled: list[flint.arb]) -> list[flint.arb]:
        found, m = [], len(self.places)
        for k, rolls in enumerate(self._rolling):
            if not rolls:
                found.append(sampled[k])
                continue
            at_speeds = sampled[k::m]
            found += [sum((x * w for x, w in zip(at_speeds, row, strict=True)), flint.arb(0)) for row in self._inverse]
        return found


def structure_of(model: LinearModel) -> Any:
    """Structure of a model; of one whose tyre has states alone the whole, with no wheel that remembers."""
    if model.structure is not None:
        return model.structure
    load, data = ca.SX.sym("load"), ca.SX.sym("data", model.state_matrix.numel_in(3))
    nothing = ca.Function("footprint", [load, data], [ca.SX(ca.DM.zeros(1, len(FOOTPRINT)))])
    return SimpleNamespace(
        states=model.states,
        wheels=0,
        system=model.state_matrix,
        footprint=nothing,
        powers=model.powers,
        design_names=model.design_names,
    )
