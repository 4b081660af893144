"""The loads that a study names, and the table of its load cases."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, GetJsonSchemaHandler, model_validator
from pydantic_core import CoreSchema

from ..expressions.calculus import Expr, absolute, is_symbol, where
from ..load_cases.base import Context, LoadCase, Row, larger, load_cases, load_table, standard_cases, worst_torque
from ..quantities.kinds import union_of
from ..quantities.record import Force, Name, Record, Torque, refuse
from ..quantities.units import Quantity
from ..reading import quoted

__all__ = ["GroundLoads"]

Mass = Annotated[float, Quantity("kg", above=0, example="250 kg")]

SERVICE_SHARE = 0.25
"""Torque of everyday turns over the largest static yaw torque of the rules."""


_GIVEN = ("gear", "landing_vertical", "static_reaction", "aircraft_weight", "brake_torque", "unsprung_mass")
"""Keys that stand in the context as they are."""


def _by_name(found: Any) -> Any:
    """Cases by name: a list names those that count, true and false switch, and a name that is a kind needs no tag."""
    if isinstance(found, (list, tuple)):
        known = standard_cases()
        for position, name in enumerate(found):
            if not isinstance(name, str) or name not in known:
                allowed = f"{', '.join(known)}; cases of one's own in a mapping"
                raise refuse(str(position), f"{quoted(name)} is no load case", allowed)
        return {kind: {"kind": kind, "enabled": kind in found} for kind in known}
    if not isinstance(found, dict):
        return found
    return {name: _block(name, block) for name, block in found.items()}


def _block(name: str, block: Any) -> Any:
    known = load_cases()
    if isinstance(block, bool):
        if name not in standard_cases():
            allowed = f"{', '.join(standard_cases())}, or a block with its kind"
            raise refuse(name, f"{quoted(name)} is no load case", allowed)
        return {"kind": name, "enabled": block}
    if not isinstance(block, dict):
        return block
    if "kind" not in block and name in known:
        return {"kind": name, **block}
    if name in known and block["kind"] != name:
        raise refuse(f"{name}.kind", f"{quoted(block['kind'])} under the name of another case", f"'{name}', or another name")
    return block


_CASE: Any = union_of(load_cases(), ("kind",))


class GroundLoads(Record):
    """Loads of landing and ground handling, and which load cases count."""

    gear: Literal["main", "nose"] = "main"
    """Kind of gear, which decides what rules it has."""
    landing_vertical: Force | None = None
    """Largest vertical reaction of a level landing [N]; left out: landing cases have the largest vertical load of the
    envelope, whatever part of a landing the rule takes."""
    static_reaction: Force | None = None
    """Of the gear at ramp weight [N]; left out: the largest vertical load of the envelope."""
    aircraft_weight: Force | None = None
    """At ramp, a force [N]; towing needs it."""
    brake_torque: Torque | None = None
    """Nominal maximum static torque of the gear's brakes [N m]."""
    unsprung_mass: Mass | None = None
    """Of wheels, brakes, piston [kg]; rebound needs it."""
    cases: Annotated[dict[Name, _CASE], BeforeValidator(_by_name)] = {}  # noqa: RUF012  # frozen, and copied by pydantic
    """Cases by name: true or false, or numbers other than the rule's, or cases of one's own (kind: given); a list names the
    only ones that count."""

    def constants(self) -> tuple[str, ...]:
        """The numbers of a rule."""
        return ("cases",)

    @model_validator(mode="after")
    def _enabled_with_numbers(self) -> Self:
        for name, case in self.cases.items():
            lacking = [key for key in case.NEEDS if key in type(self).model_fields and getattr(self, key) is None]
            if case.enabled and lacking:
                raise refuse(f"cases.{name}", f"enabled without {lacking[0]}", f"loads.{lacking[0]}, or leave the case off")
        if all(case.enabled is False for case in self.all_cases.values()):
            raise refuse("cases", "no case is left", "one case that counts, or more")
        return self

    @property
    def all_cases(self) -> dict[str, LoadCase]:
        """Every case: the rules', as given or at their defaults, then a user's own."""
        return {**standard_cases(), **self.cases}

    def context(self, study: Any, shimmy_torque: Expr = None, load: Expr = None) -> Context:
        """The gear of a study as its load cases see it.

        Parameters
        ----------
        study : Study
            Floats or symbols.
        shimmy_torque : Expr or None
            Peak yaw torque of the simulated release or kick [N m].
        load : Expr or None
            Largest vertical load [N]; None: that of the study's envelope.
        """
        gear, tyre, required = study.gear, study.tyre, study.requirements
        load = max(study.envelope.loads) if load is None else load
        at_rest = {state.name: 0.0 for state in gear.states()}
        wheels = gear.wheels(at_rest, study.envelope.speed.max, load)
        half_track = getattr(getattr(gear, "axle", None), "half_track", 0.0)
        tyres = [tyre.of_wheel(wheel) for wheel in wheels]
        side, moment, _, a = tyres[0].linear(wheels[0].load, tyres[0].pressure)
        # a trail beyond the footprint is no trail of a tyre
        trail = a if not is_symbol(side) and side == 0 else larger(0.0, where(moment < a * side, moment / side, a))
        peaks = [own.peaks(wheel.load, own.pressure) for own, wheel in zip(tyres, wheels, strict=True)]
        e_eff = gear.lever()
        of_wheels = [None if of is None else of.aligning_moment + absolute(e_eff) * of.side_force for of in peaks]
        return Context(
            largest_vertical=load,
            e_eff=e_eff,
            trail=trail,
            half_contact_length=a,
            wheel_radius=gear.wheel_radius,
            half_track=half_track,
            wheels=len(wheels),
            tyre_moment=None if any(of is None for of in of_wheels) else sum(of_wheels),
            limit_torque=None if required is None else required.limit_torque,
            limit_torque_factor=1.5 if required is None else required.limit_torque_factor,
            shimmy_torque=shimmy_torque,
            **{key: getattr(self, key) for key in _GIVEN},
        )

    def table(self, study: Any, shimmy_torque: Expr = None, load: Expr = None) -> tuple[Row, ...]:
        """Load cases of a study: those that count, and the others with the reason.

        Parameters
        ----------
        study : Study
            Floats or symbols.
        shimmy_torque : Expr or None
            Peak yaw torque of the simulated release or kick [N m].
        load : Expr or None
            Largest vertical load [N]; None: that of the study's envelope.
        """
        return load_table(self.all_cases, self.context(study, shimmy_torque, load))

    def limit_torque(self, study: Any, shimmy_torque: Expr = None, load: Expr = None) -> Expr:
        """Largest limit yaw torque of the cases that count [N m].

        Parameters
        ----------
        study : Study
            Floats or symbols, with requirements.
        shimmy_torque : Expr or None
            Peak yaw torque of the simulated release or kick [N m].
        load : Expr or None
            Largest vertical load [N]; None: that of the study's envelope.
        """
        return worst_torque(self.table(study, shimmy_torque, load))

    def service_torque(self, study: Any, load: Expr = None) -> Expr:
        """Torque under which the damper has its working stroke [N m].

        Given, or a quarter of the largest static yaw torque that the rules' cases have at the largest vertical load of the
        envelope. No limit load, factor, or case of the study enters: more of them would make a stroke easier to have.

        Parameters
        ----------
        study : Study
            Floats or symbols, with requirements.
        load : Expr or None
            Largest vertical load [N]; None: that of the study's envelope.
        """
        if study.requirements.service_torque is not None:
            return study.requirements.service_torque
        nothing: dict[str, Any] = dict.fromkeys((*_GIVEN[1:], "tyre_moment", "limit_torque", "shimmy_torque"))
        at_envelope = replace(self.context(study, load=load), **nothing)
        return SERVICE_SHARE * worst_torque(load_table(standard_cases(), at_envelope), static_only=True)

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        """A case of a known name may leave its kind out, or be true or false; a list has names."""
        found = handler.resolve_ref_schema(handler(schema))
        block: dict[str, Any] = found["properties"]["cases"]
        own = block.pop("additionalProperties")
        for key in ("type", "propertyNames"):
            block.pop(key, None)
        known: dict[str, Any] = {
            name: {"description": (type(case).__doc__ or "").partition("\n")[0], "type": ["boolean", "object"]}
            for name, case in standard_cases().items()
        }
        names = {"type": "array", "items": {"enum": list(known)}}
        block["anyOf"] = [{"type": "object", "properties": known, "additionalProperties": own}, names]
        return found
