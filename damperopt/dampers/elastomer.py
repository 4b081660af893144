"""Elastomer dampers: a block of rubber sheared along the stroke, with its loss factor met by a spring and a dashpot.

A loss factor eta, k (1 + i eta), belongs to no motion over time and is never put into a proof: a Kelvin-Voigt or a Zener
element is fitted to it at the frequency of shimmy.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, ClassVar, Literal

from ..expressions.calculus import Expr, sqrt
from ..expressions.corners import Corners
from ..ports.sizing import Force, LimitEvent, Sized
from ..quantities.named import DesignVariable, State
from ..quantities.record import Density, Stress
from ..quantities.units import Quantity
from .base import Context, Damper

__all__ = ["KelvinVoigt", "Zener"]


class _Rubber(Damper):
    """What both have: the loss at a frequency, and the block."""

    VARIABLES: ClassVar = (
        DesignVariable("k_elastomer", "N/m", "$k_e$", "static stiffness of the elastomer along the stroke", example="1e5 N/m"),
    )

    loss_factor: Annotated[float, Quantity("1", above=0, below=2, example="0.2")]
    """eta at `loss_frequency`: loss over storage stiffness [1]."""
    loss_frequency: Annotated[float, Quantity("rad/s", above=0, example="70 rad/s")]
    """omega at which the loss factor is met, that of shimmy [rad/s]."""
    shear_modulus: Stress = 1e6
    """G of the rubber [Pa]."""
    largest_shear: Annotated[float, Quantity("1", above=0, at_most=1, example="0.4")] = 0.4
    """Shear strain at the stroke of the limit event [1]."""
    rubber_density: Density = 1100.0
    """[kg/m^3]"""

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """Storage stiffness and loss over the frequency, at any amplitude."""
        raise NotImplementedError  # both kinds say it

    def peak_force(self, design: Mapping[str, Expr], rate: Expr) -> Expr:
        """Force of an oscillation at the loss frequency with this largest rate [N]."""
        omega = self.loss_frequency
        k, c = self.equivalent(design, 1.0, omega, Context())
        return sqrt(k**2 + (omega * c) ** 2) * rate / omega

    def parts(self, event: LimitEvent, model: Any) -> Sized:
        """Rubber of the thickness that the strain asks for and the area that the stiffness asks for, between two plates."""
        rate = event.stroke * event.yaw_rate / event.yaw
        stiffness = event.damper_force * self.loss_frequency / rate
        thickness = event.stroke / self.largest_shear
        area = stiffness * thickness / self.shear_modulus
        plates = 2 * area * model.wall_allowance * model.damper_material.density
        return Sized({"damper": (1 + model.damper_fittings_fraction) * plates + self.rubber_density * area * thickness})

    def leaves_out(self) -> tuple[str, ...]:
        """What a linear element of rubber does not hold."""
        return ("loss and stiffness of the rubber over amplitude and temperature (damper.loss_factor is met at one frequency)",)


class KelvinVoigt(_Rubber):
    """Elastomer as a spring and a dashpot side by side, F = k x + c v with c = eta k/omega."""

    kind: Literal["kelvin_voigt"]

    def _damping(self, design: Mapping[str, Expr]) -> Expr:
        return self.loss_factor * design["k_elastomer"] / self.loss_frequency

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = k x + c v."""
        return Force(design["k_elastomer"] * stroke + self._damping(design) * rate)

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr:
        """(F - k x)/c."""
        return (force - design["k_elastomer"] * stroke) / self._damping(design)

    def damping(self, design: Mapping[str, Expr]) -> None:
        """No one number: its stiffness acts too."""

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """k and c, at every frequency."""
        return design["k_elastomer"], self._damping(design)


class Zener(_Rubber):
    """Elastomer as a standard linear solid, F = k_0 x + k_1 (x - z) with tau z' = x - z, and the loss factor as its peak.

    With r = 1 + k_1/k_0 the loss factor is largest at omega tau = 1/sqrt(r), where it is (r - 1)/(2 sqrt(r)).
    """

    STATES: ClassVar = (State("relaxed_stroke", "m", "elastomer"),)
    FEELS_RATE: ClassVar = False

    kind: Literal["zener"]

    @property
    def _ratio(self) -> Expr:
        """r of a peak loss factor eta."""
        return (self.loss_factor + sqrt(1 + self.loss_factor**2)) ** 2

    @property
    def _time(self) -> Expr:
        """tau [s]."""
        return 1 / (self.loss_frequency * sqrt(self._ratio))

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """F = k_0 x + k_1 (x - z), z' = (x - z)/tau."""
        k_0, stretched = design["k_elastomer"], stroke - states["relaxed_stroke"]
        force = k_0 * stroke + (self._ratio - 1) * k_0 * stretched
        return Force(force, {"relaxed_stroke": stretched / self._time})

    def equivalent(self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context) -> tuple[Expr, Expr]:
        """k_0 + k_1 s tau/(1 + s tau) at s = i omega."""
        k_0, k_1, turn = design["k_elastomer"], (self._ratio - 1) * design["k_elastomer"], frequency * self._time
        share = k_1 / (1 + turn**2)
        return k_0 + share * turn**2, share * self._time
