"""Records of a study: frozen, floats in SI, the same names as the keys of the YAML file.

Every record refuses unknown keys, non-finite numbers and values out of range. `config.load` makes them from a file;
in a notebook they can be made directly or changed with `Study.replace`.
"""

from __future__ import annotations

from html import escape
from typing import Annotated, Any, Literal, Self

import yaml
from pydantic import BaseModel, BeforeValidator, Discriminator, Field, Tag, ValidationError, WithJsonSchema, model_validator

from ..errors import ConfigError
from ..linkages.joints import EndStop, Freeplay, Friction, Orifice
from ..quantities.record import (
    Angle,
    Coordinate,
    Force,
    Inertia,
    Length,
    LoadRange,
    Name,
    Record,
    SeriesStiffness,
    SpeedRange,
    TorsionalDamping,
    TorsionalStiffness,
    quantity_of,
    refuse,
)
from ..quantities.units import Quantity
from ..strength.materials import Material
from .changes import changed
from .requirements import MassModel, Requirements
from .variables import DESIGN_VARIABLES, TOPOLOGIES, Design, Solver, Variable

__all__ = [
    "Damper",
    "Envelope",
    "Gear",
    "LateralMode",
    "LinearTyre",
    "StraightTangentTyre",
    "StringTyre",
    "Study",
    "unit_of",
]


class LateralMode(Record):
    """Lateral bending of the strut about its attachment; only the fifth-order gear has it."""

    inertia: Inertia
    stiffness: TorsionalStiffness
    damping: TorsionalDamping
    height: Length


class Gear(Record):
    """Landing gear. `order` 3: yaw and tyre string; 5: lateral bending too (a `lateral` block is then required)."""

    order: Literal[3, 5]
    yaw_inertia: Inertia
    caster_length: Coordinate
    rake_angle: Angle = 0.0
    wheel_radius: Length
    lateral: LateralMode | None = None
    friction: Friction | None = None

    @model_validator(mode="after")
    def _lateral_of_fifth_order(self) -> Self:
        if self.order == 5 and self.lateral is None:
            raise refuse("lateral", "missing key", "order 5 needs the block lateral (inertia, stiffness, damping, height)")
        return self


class _Tyre(Record):
    half_contact_length: Length
    relaxation_length: Length
    tread_width_moment: Annotated[float, Quantity("N m^2/rad", at_least=0, example="570 N m^2/rad")] = 0.0
    slip_range: Annotated[float, Quantity("rad", above=0, below=1.5, example="45 deg")] = 0.7853981633974483
    """Slip angle up to which the law is trusted; a simulation stops there [rad]."""


class StringTyre(_Tyre):
    """Stretched string with the nonlinear side force C_F X cos(0.95 X) F_z, X = atan(7 tan(alpha)) (slope 7 C_F)."""

    law: Literal["nonlinear"]
    cornering_coefficient: Annotated[float, Quantity("1/rad", at_least=0)]
    aligning_coefficient: Annotated[float, Quantity("m/rad")]
    aligning_slip_limit: Annotated[float, Quantity("rad", above=0, below=1.5, example="10 deg")]


class LinearTyre(_Tyre):
    """Stretched string with F_y = cornering_slope alpha F_z and M_z = aligning_coefficient alpha F_z."""

    law: Literal["linear"]
    cornering_slope: Annotated[float, Quantity("1/rad", at_least=0)]
    aligning_coefficient: Annotated[float, Quantity("m/rad")]


class StraightTangentTyre(_Tyre):
    """Straight-tangent tyre: F_y = cornering_stiffness y/sigma, M_z = aligning_stiffness y/sigma, for any load.

    `carcass_stiffness` (lateral, per unit length of the string) stands for both; see `tyres.straight_tangent_stiffnesses`.
    """

    law: Literal["straight_tangent"]
    cornering_stiffness: Annotated[float, Quantity("N/rad", at_least=0)] | None = None
    aligning_stiffness: Annotated[float, Quantity("N m/rad")] | None = None
    carcass_stiffness: Annotated[float, Quantity("N/m^2", above=0)] | None = None

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        both = self.cornering_stiffness is not None and self.aligning_stiffness is not None
        either = self.cornering_stiffness is not None or self.aligning_stiffness is not None
        if not (both if self.carcass_stiffness is None else not either):
            raise refuse(
                "", "incomplete or double stiffness", "cornering_stiffness and aligning_stiffness, or carcass_stiffness alone"
            )
        return self


Tyre = Annotated[StringTyre | LinearTyre | StraightTangentTyre, Field(discriminator="law")]


class Damper(Record):
    """Layout of the shimmy damper and level of its geometry.

    `rotational` takes `torsional_stiffness` and `torsional_damping` about the yaw axis as they are.
    """

    topology: Literal["boeing", "utas", "arreaza", "rotational"]
    geometry: Literal["published", "planar", "spatial"] = "planar"
    torsional_stiffness: TorsionalStiffness | None = None
    torsional_damping: TorsionalDamping | None = None
    link_stiffness: SeriesStiffness | None = None
    """Of the torque links, laterally at the apex, in series with the linkage [N/m]."""
    series_stiffness: SeriesStiffness | None = None
    """Of oil column, rod and brackets, in series with the damper [N/m]."""
    orifice: Orifice | None = None
    freeplay: Freeplay | None = None
    end_stop: EndStop | None = None

    @model_validator(mode="after")
    def _given_for_rotational_only(self) -> Self:
        given = [key for key in ("torsional_stiffness", "torsional_damping") if getattr(self, key) is not None]
        if self.topology == "rotational" and len(given) < 2:
            raise refuse(
                "",
                "topology 'rotational' lacks torsional_stiffness or torsional_damping",
                "both, in N m/rad and N m s/rad",
            )
        if self.topology != "rotational" and given:
            raise refuse(
                given[0],
                "belongs to topology 'rotational' only",
                f"topology '{self.topology}' takes its stiffness and damping from the design variables",
            )
        if self.topology == "rotational":
            for key in ("link_stiffness", "series_stiffness", "orifice", "freeplay", "end_stop"):
                if getattr(self, key) is not None:
                    raise refuse(key, "topology 'rotational' has no linkage that it could belong to", "the other topologies")
        return self


class Envelope(Record):
    """Where the gear must be stable: every speed of a range, at one load, a list of loads, or a range of loads."""

    speed: SpeedRange
    vertical_load: Annotated[
        Annotated[LoadRange, Tag("LoadRange")] | Annotated[list[Force], Tag("list")],
        Discriminator(lambda data: "LoadRange" if isinstance(data, (dict, LoadRange)) else "list"),
        BeforeValidator(lambda data: data if isinstance(data, (dict, list, LoadRange)) else [data]),
        WithJsonSchema(
            {
                "anyOf": [
                    {"type": ["number", "string"], "description": "[N]"},
                    {"type": "array", "items": {"type": ["number", "string"]}, "minItems": 1},
                    {
                        "type": "object",
                        "properties": {"min": {"type": ["number", "string"]}, "max": {"type": ["number", "string"]}},
                        "required": ["min", "max"],
                        "additionalProperties": False,
                    },
                ]
            }
        ),
    ]

    @model_validator(mode="after")
    def _some_load(self) -> Self:
        if isinstance(self.vertical_load, list):
            if not self.vertical_load:
                raise refuse("vertical_load", "an empty list", "one load or more, or {min, max}")
            if len(set(self.vertical_load)) < len(self.vertical_load):
                raise refuse("vertical_load", "names a load twice", "different loads")
        return self

    @property
    def loads(self) -> tuple[float, ...]:
        """Vertical loads [N]: the list, or the two ends of the range."""
        load = self.vertical_load
        return (load.min, load.max) if isinstance(load, LoadRange) else tuple(load)

    @property
    def load_is_range(self) -> bool:
        return isinstance(self.vertical_load, LoadRange)


class Study(Record):
    """One design study: everything `optimise` and `analyse` need."""

    name: Name
    gear: Gear
    tyre: Tyre
    damper: Damper
    material: Material = Material.model_validate("AISI 4340")
    envelope: Envelope
    requirements: Requirements | None = None
    design: Design = Design()
    mass: MassModel = MassModel()
    solver: Solver = Solver()

    @model_validator(mode="after")
    def _complete(self) -> Self:
        decay = self.requirements.decay if self.requirements else None
        for i, speed in enumerate(decay.speeds or () if decay else ()):
            low, high = self.envelope.speed.min, self.envelope.speed.max
            if not low <= speed <= high:
                allowed = f"speeds of the envelope, {low:g} to {high:g} m/s"
                raise refuse(f"requirements.decay.speeds.{i}", f"{speed:g} m/s is outside the envelope", allowed)
        topology = self.damper.topology
        missing = [name for name in DESIGN_VARIABLES[topology] if getattr(self.design, name) is None]
        if missing:
            raise refuse(
                f"design.{missing[0]}",
                "missing key",
                f"topology '{topology}' needs design variables {', '.join(DESIGN_VARIABLES[topology])}",
            )
        if topology in TOPOLOGIES:
            if self.requirements is None:
                raise refuse("requirements", "missing key", f"the block requirements, which topology '{topology}' needs")
            tyre = self.tyre
            peakless = tyre.law != "nonlinear" or tyre.aligning_coefficient == tyre.cornering_coefficient == 0
            if self.requirements.limit_torque is None and peakless:
                raise refuse(
                    "requirements.limit_torque",
                    "missing key",
                    f"a torque: this tyre (law '{tyre.law}') has no peak moment to derive it from",
                )
        return self

    @property
    def required(self) -> Requirements:
        """The requirements; every layout that can be optimised has them."""
        if self.requirements is None:
            raise ConfigError(f"{self.name}: requirements: missing key; allowed: the block requirements, with stability_margin")
        return self.requirements

    def variable(self, name: str) -> Variable:
        """The design variable `name`, which the layout must have."""
        variable: Variable = getattr(self.design, name)
        return variable

    @property
    def start(self) -> dict[str, float]:
        """Design at the starts of the layout's design variables [SI]."""
        return {name: self.variable(name).start for name in DESIGN_VARIABLES[self.damper.topology]}

    def _repr_html_(self) -> str:
        """The study as notebooks show it: every key, in SI."""
        text = yaml.safe_dump(self.model_dump(mode="json", exclude_none=True), sort_keys=False, allow_unicode=True)
        return f"<details open><summary>{escape(self.name)}</summary><pre>{escape(text)}</pre></details>"

    def replace(self, **changes: Any) -> Study:
        """The study with some keys changed, checked again as a whole.

        Parameters
        ----------
        **changes : object
            New values by key path with ``__`` for the dots: ``damper__topology="utas"``, ``envelope__speed__max=80``.

        Returns
        -------
        Study
            A new record; this one stays as it is.

        Raises
        ------
        ConfigError
            If a key does not exist or the new study is not valid.
        """
        data = changed(self.model_dump(), {path.replace("__", "."): value for path, value in changes.items()})
        try:
            return Study.model_validate(data)
        except ValidationError as error:
            raise ConfigError([_problem_in_words(problem) for problem in error.errors(include_url=False)]) from None


def _problem_in_words(problem: Any) -> str:
    path = [*problem["loc"], *filter(None, [problem.get("ctx", {}).get("key")])]
    what = "unknown key" if problem["type"] == "extra_forbidden" else problem["msg"]
    return f"{'.'.join(map(str, path))}: {what}"


def unit_of(study: Study, path: str) -> str:
    """SI unit of the number at a key path such as ``gear.lateral.height``.

    Parameters
    ----------
    study : Study
    path : str

    Returns
    -------
    str
        ``"1"`` for plain numbers.
    """
    *parents, leaf = path.split(".")
    record: Any = study
    for key in parents:
        record = getattr(record, key)
    field = type(record).model_fields[leaf]
    quantity = quantity_of(field.annotation, field.metadata)
    return quantity.unit if quantity else "1"
