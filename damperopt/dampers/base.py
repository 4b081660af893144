"""What every damper is: a force along a stroke, states of its own, and the parts that carry it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

from ..expressions.calculus import Expr, slope
from ..expressions.corners import Corners, Linear
from ..ports.linkage import Compliant
from ..ports.sizing import Force, LimitEvent, Sized
from ..quantities.named import DesignVariable, Output, State
from ..quantities.record import Record

__all__ = ["FORGOTTEN", "Context", "Damper"]


FORGOTTEN = 1e3
"""Rate [1/s] at which a linear model of hysteresis forgets the force of an earlier slide, which would be a root at 0."""


@dataclass(frozen=True)
class Context:
    """Where a damper works; expressions.

    Attributes
    ----------
    load, speed : Expr
        F_z [N], V [m/s].
    temperature : Expr
        [K]; None: at the reference of the damper's numbers.
    current : Expr
        [A]; 0: none.
    axle : Expr
        Lever of the axle about the strut axis, the caster length [m].
    wanted : Expr
        Force against the stroke that a control law wants of the damper [N]; None: there is no law.
    outputs : mapping of str to Expr
        Of the gear, for dampers that are driven by a measurement.
    """

    load: Expr = 0
    speed: Expr = 0
    temperature: Expr = None
    current: Expr = 0
    axle: Expr = 0
    wanted: Expr = None
    outputs: Mapping[str, Expr] = field(default_factory=dict)


class Damper(Record):
    """A shimmy damper along the stroke of a linkage, or about the yaw axis.

    A damper is a file of its own with a class derived from this one, a literal `kind`, its `VARIABLES` and `STATES`, and the
    method `force`. In a study its keys stand in the block `damper` beside those of the layout.
    """

    GROUP: ClassVar[str] = "damperopt.dampers"
    VARIABLES: ClassVar[tuple[DesignVariable, ...]] = ()
    """Numbers of the damper that the optimiser may choose."""
    ELASTIC: ClassVar[tuple[str, ...]] = ()
    """Keys of the block ``compliance`` that this damper knows sizes for."""
    SIZES: ClassVar[tuple[DesignVariable, ...]] = ()
    """Sizes of elastic parts that may be chosen beside `VARIABLES`; which of them, `sizes` says."""
    STATES: ClassVar[tuple[State, ...]] = ()
    OUTPUTS: ClassVar[tuple[Output, ...]] = ()
    SPEED_POWERS: ClassVar[tuple[int, ...]] = (0,)
    LOAD_POWERS: ClassVar[tuple[int, ...] | None] = (0,)
    FEELS_RATE: ClassVar[bool] = True
    """Whether the force hangs on the rate; where stroke and states alone make it, a massless node beside it has no equation of
    motion of its own."""
    ROTARY: ClassVar[bool] = False
    """Whether it acts about the yaw axis: strokes are then angles, and forces torques."""
    COMMANDED: ClassVar[bool] = False
    """Whether a control law commands it, `Context.wanted`; beside other dampers an actuator does what the law wants."""
    VISCOUS: ClassVar[str] = ""
    """The design variable that uncertain damping multiplies; empty: none."""

    kind: str

    def force(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        rate: Expr,
        context: Context,
        corners: Corners,
    ) -> Force:
        """Force along the stroke, and the rates of the damper's own states.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        states : mapping of str to Expr
            Own states by name.
        stroke, rate : Expr
            From rest [m], and its rate [m/s]; rad and rad/s for a rotary damper.
        context : Context
        corners : Corners
            Version of the nonlinear elements.
        """
        raise NotImplementedError  # every kind says it

    def rate(
        self,
        design: Mapping[str, Expr],
        states: Mapping[str, Expr],
        stroke: Expr,
        force: Expr,
        context: Context,
        corners: Corners,
    ) -> Expr | None:
        """Rate of the stroke at a force, where that has a closed form; None: it is made an unknown of the equations."""
        return None

    def series(self, design: Mapping[str, Expr]) -> Expr | None:
        """Stiffness in series with the damper [N/m]; None where there is none."""
        return None

    def sizes(self) -> tuple[DesignVariable, ...]:
        """Those of `SIZES` that this damper has."""
        return ()

    def elastic(self, design: Mapping[str, Expr], study: Any, stroke: Expr = 0) -> tuple[Compliant, ...]:
        """What gives way in the damper, from the sizes that it has.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        study : Study
            Floats or symbols: mass model.
        stroke : Expr
            Of the shock strut [m].
        """
        return ()

    def is_sized(self, part: str) -> bool:
        """Whether the stiffness of a part of the chain comes from its section; the study's compliance says it."""
        return False

    def given_compliance(self) -> dict[str, Any]:
        """Stiffnesses that the study gives as numbers, by the names of the parts."""
        return {}

    def damping_factors(self) -> tuple[float, float]:
        """Least and largest factor on the damping that the requirements must survive; both 1 where it is certain."""
        return 1.0, 1.0

    def dampings(self, between: int = 5) -> list[float]:
        """Ends of `damping_factors` and factors of even ratio between them; one alone where the damping is certain."""
        low, high = self.damping_factors()
        if low == high:
            return [low]
        return [low, *(low * (high / low) ** (k / (between + 1)) for k in range(1, between + 1)), high]

    def damping_by_temperature(self) -> dict[float, float]:
        """Factor on the damping by temperature of the oil [K]; empty where the study says nothing of temperature."""
        return {}

    def orifice_share(self) -> float | None:
        """What of the damping is an orifice [1]; None where the study says nothing of temperature."""
        return None

    def with_damping(self, design: Mapping[str, Expr], factor: Expr) -> dict[str, Expr]:
        """The design with its damping times a factor: what has been built stays, the oil is another."""
        return {**design, self.VISCOUS: factor * design[self.VISCOUS]} if self.VISCOUS in design else dict(design)

    def damping(self, design: Mapping[str, Expr]) -> Expr | None:
        """Slope of the force over the rate at rest [N s/m]; None where no one number says it."""
        if self.STATES:
            return None
        return slope(lambda rate: self.force(design, {}, 0.0, rate, Context(), Linear()).force, 0.0)

    def equivalent(
        self, design: Mapping[str, Expr], amplitude: Expr, frequency: Expr, context: Context
    ) -> tuple[Expr, Expr] | None:
        """Stiffness [N/m] and damping [N s/m] that have the first harmonic of the force along a sinusoidal stroke.

        None where no formula says it. Exact for a linear damper; of a nonlinear one the describing function.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        amplitude, frequency : Expr
            Of the stroke [m], or [rad] for a rotary damper; omega [rad/s].
        context : Context
        """
        return None

    def peak_force(self, design: Mapping[str, Expr], rate: Expr) -> Expr:
        """Force at the largest rate of the limit event [N], as the linear model has it."""
        at_rest = dict.fromkeys((state.name for state in self.STATES), 0.0)
        return self.force(design, at_rest, 0.0, rate, Context(), Linear()).force

    def parts(self, event: LimitEvent, model: Any) -> Sized | None:
        """Masses of the damper, sized by the limit event; None: it has no mass model and cannot be optimised.

        Parameters
        ----------
        event : LimitEvent
        model : MassModel
        """
        return None

    def piston(self, design: Mapping[str, Expr]) -> Expr | None:
        """Area of the piston of a cylinder whose sizes are chosen one by one [m^2]; None: there is none.

        Parameters
        ----------
        design : mapping of str to Expr
            Design variables by name [SI].
        """
        return None

    def leaves_out(self) -> tuple[str, ...]:
        """What this model of a damper does not hold, in words."""
        return ()
