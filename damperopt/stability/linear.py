"""Linear model of a gear: state matrices at any speed and load, spectral abscissa."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

import casadi as ca
import numpy as np

from ..dynamics import build
from ..errors import ConfigError
from ..expressions.dae import DAE
from ..study.study import Study
from ..symbols import data_values, symbolic
from .delay import delay_gear
from .family import powers_of
from .gear import LinearGear, spectral_abscissa
from .response import Structure

__all__ = ["LinearGear", "LinearModel", "linear_gear", "linearise", "spectral_abscissa"]


def linearise(dae: DAE) -> ca.Function:
    """State matrix at the equilibrium x = 0, by automatic differentiation.

    Parameters
    ----------
    dae : DAE

    Returns
    -------
    casadi.Function
        (design, speed, load, data) -> (n, n) matrix f_x - f_z g_z^-1 g_x.
    """
    at_rest = ca.vertcat(dae.x, dae.z), ca.vertcat(ca.SX.zeros(dae.x.shape), dae.rest)
    f_x, f_z, g_x, g_z = (
        ca.substitute(ca.jacobian(f, v), *at_rest) for f, v in itertools.product((dae.ode, dae.alg), (dae.x, dae.z))
    )
    A = ca.densify(f_x - f_z @ ca.inv_minor(g_z) @ g_x if dae.z.numel() else f_x)
    return ca.Function("state_matrix", [dae.design, dae.speed, dae.load, dae.data], [A])


class LinearModel:
    """Linear model of a study, built once; `at(design)` gives the gear with a design.

    Parameters
    ----------
    study : Study
    """

    def __init__(self, study: Study):
        dae = build(symbolic(study))
        self.states, self.state_names = dae.states, dae.state_names
        self.design_names = dae.design_names
        self.state_matrix = linearise(dae)
        self.powers = powers_of(study)
        self.structure = None if study.tyre.contact.RATIONAL else Structure(study)
        if self.structure is not None and self.structure.footprint is None:
            raise ConfigError(
                f"tyre.contact: '{study.tyre.contact.contact}' says that it is not RATIONAL and is no StringLine; "
                "allowed: a line whose states stand for all of it, or one with the weights of a StringLine"
            )
        self._data = ca.DM(data_values(study))

    def at(self, design: Mapping[str, float]) -> LinearGear:
        """The gear with `design` (design variables by name, SI); `ConfigError` if one is missing or not positive."""
        n = len(self.state_names)
        wrong = [name for name in self.design_names if not 0 < design.get(name, np.nan) < np.inf]
        if wrong:
            raise ConfigError(
                f"design.{wrong[0]}: found {design.get(wrong[0], 'nothing')}; "
                f"allowed: positive finite {', '.join(self.design_names)}"
            )
        values = ca.DM([design[name] for name in self.design_names])

        def matrices(speeds: Any, loads: Any) -> np.ndarray:
            V, F_z = np.broadcast_arrays(np.atleast_1d(np.asarray(speeds, float)), np.asarray(loads, float))
            columns = self.state_matrix(ca.repmat(values, 1, V.size), V.reshape(1, -1), F_z.reshape(1, -1), self._data)
            return columns.full().reshape(n, V.size, n).transpose(1, 0, 2)

        if self.structure is None:
            return LinearGear(matrices, self.states, self.powers)
        return delay_gear(self.structure, design, matrices, self.states)


def linear_gear(study: Study, design: Mapping[str, float] | None = None) -> LinearGear:
    """Linear model of a study with a design.

    Parameters
    ----------
    study : Study
    design : mapping or None
        Design variables [SI]; None: the starts of the study.

    Returns
    -------
    LinearGear
    """
    model = LinearModel(study)
    if design is None:
        design = study.start
    return model.at(design)
