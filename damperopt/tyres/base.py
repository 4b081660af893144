"""What a tyre is: a contact line and a slip law, and the numbers that both share.

The contact line turns the motion of the wheel into two slip angles, alpha_F for the side force and alpha_M for the aligning
moment; the slip law turns these into force and moment. Any contact line goes with any law. M_z > 0 restores a positive
yaw.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any, ClassVar, Self

from pydantic import GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ..expressions.calculus import Expr, is_symbol, slope
from ..expressions.corners import Corners
from ..ports.over_load import OverLoad
from ..ports.sizing import Peaks
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Pressure, Record, refuse
from ..quantities.units import Quantity
from .over_load import LengthOverLoad

__all__ = ["AtLoad", "ContactLine", "Linear", "SlipLaw", "Slips", "Tyre"]


@dataclass(frozen=True)
class Linear:
    """A tyre at small slip; expressions, each possibly of load and pressure.

    Attributes
    ----------
    cornering_stiffness : Expr
        C_Fa, slope of the side force [N/rad].
    aligning_stiffness : Expr
        C_Ma, slope of the aligning moment [N m/rad].
    relaxation_length, half_contact_length : Expr
        sigma and a [m].
    half_contact_length_rate : Expr
        Of a, as the load changes along a history [m/s].
    """

    cornering_stiffness: Expr
    aligning_stiffness: Expr
    relaxation_length: Expr
    half_contact_length: Expr
    half_contact_length_rate: Expr = 0

    def __iter__(self) -> Any:
        """C_Fa, C_Ma, sigma, a: for equations."""
        yield from (self.cornering_stiffness, self.aligning_stiffness, self.relaxation_length, self.half_contact_length)


@dataclass(frozen=True)
class Slips:
    """What a contact line makes of the motion of a wheel; expressions.

    Attributes
    ----------
    rates : sequence of Expr
        Derivatives of the states of the line, in their order.
    force, moment : Expr
        Slip angles alpha_F and alpha_M [rad].
    """

    rates: Sequence[Expr]
    force: Expr
    moment: Expr

    def __iter__(self) -> Any:
        """rates, alpha_F, alpha_M."""
        yield from (self.rates, self.force, self.moment)


class SlipLaw(Record):
    """Static side force and aligning moment of a tyre over slip, load and pressure.

    A law is a file of its own with a class derived from this one, a literal `law`, and the methods below. In a study its
    keys stand in the block `tyre` beside those that all tyres share, so that `self` has these too.
    """

    GROUP: ClassVar[str] = "damperopt.slip_laws"
    LOAD_POWERS: ClassVar[tuple[int, ...] | None] = (0, 1)
    """Powers of F_z in the linear model; None: no polynomial in F_z, so that proofs go load by load."""
    ODD: ClassVar[bool] = True
    """Whether force and moment change sign with the slip."""
    GIVES: ClassVar[tuple[str, ...]] = ()
    """Keys of `Tyre` that the law knows by itself, as functions of load and pressure: a study may leave them out (None)."""
    TABLE: ClassVar[tuple[Output, ...]] = ()
    """What else the law knows of the tyre at a load, for a table: names, units, meanings of `others`."""

    law: str

    def linear(self, load: Expr, pressure: Expr) -> Any:
        """Small-slip data C_Fa [N/rad], C_Ma [N m/rad], sigma [m], a [m] at a load [N] and a pressure [Pa].

        Returns
        -------
        Linear or tuple
            In this order.
        """
        raise NotImplementedError  # every law says it

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """Side force F_y [N] at a slip angle [rad]."""
        raise NotImplementedError  # every law says it

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """Aligning moment M_z [N m] at a slip angle [rad], positive where it restores."""
        raise NotImplementedError  # every law says it

    def peaks(self, load: Expr, pressure: Expr) -> Peaks | None:
        """Largest force and moment at a load; None where the law has no peak, and a limit torque must be given."""
        return None

    def others(self, load: float, pressure: float | None) -> dict[str, float]:
        """Values of `TABLE` at a load [N] and a pressure [Pa], by name [SI]."""
        return {}

    def beyond(self, load: float, pressure: float | None) -> str:
        """Why the law has no answer at a load of the wheel [N], in words; empty where it has one."""
        return ""

    def loads(self) -> tuple[float, float] | None:
        """Loads for which its numbers are made [N], for tables; None where the numbers do not say."""
        return None

    def radius(self) -> float | None:
        """Radius of the tyre without load [m], where its numbers hold it."""
        return None

    def leaves_out(self) -> tuple[str, ...]:
        """What this law does not hold, in words."""
        return ()

    def origin(self) -> str:
        """Where its numbers come from if not from the study, and how far they hold: a sentence, or nothing."""
        return ""


class ContactLine(Record):
    """How the string of a tyre meets the ground.

    A line is a file of its own with a class derived from this one, a literal `contact`, and the methods below.
    """

    GROUP: ClassVar[str] = "damperopt.contact_lines"
    STATES: ClassVar[tuple[State, ...]] = ()
    """States of the line, of one wheel."""
    SPEED_POWERS: ClassVar[tuple[int, ...]] = (0, 1)
    """Powers of V in the linear model."""
    LOAD_POWERS: ClassVar[tuple[int, ...] | None] = (0,)
    """Powers of F_z that it brings in beside those of the law; None: no polynomial in F_z."""
    RATIONAL: ClassVar[bool] = True
    """Whether its transfer functions are rational, so that states stand for all of it."""
    RELAXES: ClassVar[bool] = True
    """Whether it needs `relaxation_length`; a line that has another number for it says no."""

    contact: str

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """In a file the tag of a block may stand under ``kind``."""
        found = handler(schema)
        block = handler.resolve_ref_schema(found)
        if "contact" in block.get("properties", {}):
            block["properties"]["kind"] = dict(block["properties"]["contact"])
            block["required"] = [key for key in block.get("required", ()) if key != "contact"]
            block["oneOf"] = [{"required": ["contact"]}, {"required": ["kind"]}]
        return found

    def states(self) -> tuple[State, ...]:
        """States of the line, of one wheel; a line whose numbers say how many it has says it here."""
        return self.STATES

    def slips(self, wheel: Wheel, linear: Linear, x: Sequence[Expr]) -> Any:
        """Rates of the states and the slip angles.

        Parameters
        ----------
        wheel : Wheel
        linear : Linear
            C_Fa, C_Ma, sigma, a of the slip law at this load.
        x : sequence of Expr
            States, in their order.

        Returns
        -------
        Slips or tuple
            rates, alpha_F, alpha_M.
        """
        raise NotImplementedError  # every line says it

    def response(self, s: Expr, linear: Linear, speed: Expr = 1.0) -> tuple[Expr, Expr, Expr, Expr]:
        """Transfer functions of path, F/theta, F/eta, M/theta, M/eta, at the path frequency s = lambda/V [1/m].

        The speed V [m/s] counts for lines with a clock of their own alone.
        """
        raise NotImplementedError  # every line says it

    def realisation(self, purpose: str) -> ContactLine:
        """The line whose states stand for this one: ``motion``, in transients, or ``search``, in an optimisation."""
        return self

    def side_stiffness(self, linear: Linear) -> Expr:
        """K_y of the tyre standing, side force over side deflection [N/m]: of a string, C_Fa/(a + sigma); None: unknown."""
        if linear.relaxation_length is None:
            return None
        return linear.cornering_stiffness / (linear.half_contact_length + linear.relaxation_length)

    def least_wave(self) -> float:
        """Contact lengths per wavelength of the motion below which this line is doubtful; 0 of an exact one.

        A point without memory has a force or a moment that is off by a fifth at 16, and critical speeds by a third at 12.
        """
        return 16.0

    def leaves_out(self) -> tuple[str, ...]:
        """What this line does not hold, in words."""
        return ()


class AtLoad(Record):
    """Stands before a slip law, whose equations then see a key that is a table over load as its value at that load."""

    def at(self, load: Expr) -> Self:
        """The tyre with every table at a load [N]; itself where it has none."""
        found = {key: table.at(load) for key, table in self._tables().items()}
        return self.model_copy(update=found) if found else self

    def _tables(self) -> dict[str, OverLoad]:
        values = ((key, getattr(self, key)) for key in type(self).model_fields)
        return {key: value for key, value in values if isinstance(value, OverLoad)}

    @property
    def LOAD_POWERS(self) -> tuple[int, ...] | None:
        """Powers of F_z in the linear model: those of the law; a table is no polynomial."""
        law: Any = super()
        return None if self._tables() else law.LOAD_POWERS

    def linear(self, load: Expr, pressure: Expr) -> Any:
        """As that of the law."""
        law: Any = super(AtLoad, self.at(load))
        return law.linear(load, pressure)

    def force(self, alpha_F: Expr, load: Expr, pressure: Expr) -> Expr:
        """As that of the law."""
        law: Any = super(AtLoad, self.at(load))
        return law.force(alpha_F, load, pressure)

    def moment(self, alpha_M: Expr, load: Expr, pressure: Expr, corners: Corners) -> Expr:
        """As that of the law."""
        law: Any = super(AtLoad, self.at(load))
        return law.moment(alpha_M, load, pressure, corners)

    def peaks(self, load: Expr, pressure: Expr) -> Peaks | None:
        """As that of the law."""
        law: Any = super(AtLoad, self.at(load))
        found: Peaks | None = law.peaks(load, pressure)
        return found

    def others(self, load: float, pressure: float | None) -> dict[str, float]:
        """As those of the law."""
        law: Any = super(AtLoad, self.at(load))
        return dict(law.others(load, pressure))

    def loads(self) -> tuple[float, float] | None:
        """As those of the law, within the tables."""
        law: Any = super()
        ends = [law.loads(), *((table.load[0], table.load[-1]) for table in self._tables().values())]
        given = [pair for pair in ends if pair is not None]
        return (max(low for low, _ in given), min(high for _, high in given)) if given else None

    def beyond(self, load: float, pressure: float | None) -> str:
        """As that of the law; a table ends with its last point."""
        for key, table in self._tables().items():
            if not table.load[0] <= load <= table.load[-1]:
                ends = f"{table.load[0] / 1e3:g} to {table.load[-1] / 1e3:g} kN"
                return f"is beyond the table of tyre.{key}, {ends}"
        law: Any = super(AtLoad, self.at(load))
        return str(law.beyond(load, pressure))


class Tyre(Record):
    """What contact line and slip law share; `study.tyre` is one with a slip law's keys and methods beside it."""

    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        Output("slip_angle", "rad", "of the side force"),
        Output("side_force", "N"),
        Output("aligning_moment", "N m", "that of the tread width left out"),
    )

    half_contact_length: LengthOverLoad
    """a, half the length of the footprint [m]; a number, or a table over load."""
    relaxation_length: LengthOverLoad | None = None
    """sigma, decay length of the string's deflection before the footprint [m]; a number, or a table over load; needed by all
    contact lines but ``moreland``."""
    tread_width_moment: Annotated[float, Quantity("N m^2/rad", at_least=0, example="570 N m^2/rad")] = 0.0
    """kappa, moment against the swivel rate of a footprint with a width, kappa theta'/V [N m^2/rad]."""
    slip_range: Annotated[float, Quantity("rad", above=0, below=1.5, example="45 deg")] = 0.7853981633974483
    """Slip angle up to which the law is trusted; a simulation stops there [rad]."""
    pressure: Pressure | None = None
    """Of inflation [Pa]; needed by laws that depend on it."""
    contact: ContactLine
    """How the string meets the ground: the name of a contact line, or ``{kind: name, ...}`` with keys of its own."""

    @model_validator(mode="after")
    def _relaxes(self) -> Self:
        given, law = self.relaxation_length is not None, getattr(self, "LAW", None)
        if not given and law is not None and "relaxation_length" in law.GIVES:
            return self
        if self.contact.RELAXES and not given:
            raise refuse("relaxation_length", "missing key", "a length such as '0.3 m'")
        if given and not self.contact.RELAXES:
            words = f"contact {self.contact.contact} has a stiffness in its place"
            raise refuse("relaxation_length", words, "no such key, or another contact line")
        return self

    @property
    def states(self) -> tuple[State, ...]:
        """States of one wheel."""
        return self.contact.states()

    def of_wheel(self, wheel: Wheel) -> Self:
        """The tyre of one wheel, at the pressure that its gear gives it; itself where that gives none."""
        return self if wheel.pressure is None else self.model_copy(update={"pressure": wheel.pressure})

    def on_ground(self, wheel: Wheel, states: Sequence[Expr], corners: Corners) -> Contact:
        """What the ground does to a wheel.

        Parameters
        ----------
        wheel : Wheel
        states : sequence of Expr
            Of this wheel, in the order of `states`.
        corners : Corners
            Version of the nonlinear elements.
        """
        law: Any = self.of_wheel(wheel)
        p = law.pressure
        linear = Linear(*law.linear(wheel.load, p))
        if is_symbol(wheel.load_rate):
            longer = slope(lambda load: Linear(*law.linear(load, p)).half_contact_length, wheel.load)
            linear = replace(linear, half_contact_length_rate=longer * wheel.load_rate)
        rates, alpha_F, alpha_M = self.contact.slips(wheel, linear, states)
        F_y = law.force(alpha_F, wheel.load, p)
        M_z = law.moment(alpha_M, wheel.load, p, corners)
        M_kappa = self.tread_width_moment * wheel.swivel_rate / wheel.speed
        outputs = {"slip_angle": alpha_F, "side_force": F_y, "aligning_moment": M_z}
        K_y = self.contact.side_stiffness(linear)
        deflection = None if K_y is None else F_y / K_y
        return Contact(rates, F_y, M_z + M_kappa, outputs=outputs, deflection=deflection, wheel=wheel)
