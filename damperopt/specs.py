"""Records of a study: frozen, floats in SI, the same names as the keys of the YAML file.

Every record refuses unknown keys, non-finite numbers and values out of range. `config.load` makes them from a file;
in a notebook they can be made directly or changed with `Study.replace`.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    GetJsonSchemaHandler,
    Tag,
    WithJsonSchema,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError

from .errors import ConfigError
from .materials import MATERIALS
from .units import Quantity

__all__ = [
    "DESIGN_VARIABLES",
    "TOPOLOGIES",
    "Damper",
    "Design",
    "Envelope",
    "Fatigue",
    "Gear",
    "LateralMode",
    "LinearTyre",
    "MassModel",
    "Material",
    "Range",
    "Requirements",
    "Section",
    "Solver",
    "StraightTangentTyre",
    "StringTyre",
    "Study",
    "Variable",
]

TOPOLOGIES = ("boeing", "utas", "arreaza")
"""Layouts that can be optimised; ``rotational`` (stiffness and damping given directly) can only be analysed."""

DESIGN_VARIABLES: dict[str, tuple[str, ...]] = {
    "boeing": ("c_lambda", "k_lambda", "L", "gamma"),
    "utas": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "arreaza": ("c_lambda", "I_arm", "L", "gamma", "b"),
    "rotational": (),
}
"""Design variables of each layout, in the order of every table and file."""


def _refuse(key: str, what: str, allowed: str) -> PydanticCustomError:
    """Error about `key` (a path below the block that is checked; empty: the block itself)."""
    return PydanticCustomError("study", "{what}; allowed: {allowed}", {"what": what, "allowed": allowed, "key": key})


Length = Annotated[float, Quantity("m", above=0, example="0.6 m")]
Coordinate = Annotated[float, Quantity("m", example="120 mm")]
Distance = Annotated[float, Quantity("m", at_least=0, example="50 mm")]
Angle = Annotated[float, Quantity("rad", above=-1.5, below=1.5, example="9 deg")]
AcuteAngle = Annotated[float, Quantity("rad", above=0, below=1.5707963, example="31 deg")]
Inertia = Annotated[float, Quantity("kg m^2", above=0, example="100 kg m^2")]
TorsionalStiffness = Annotated[float, Quantity("N m/rad", at_least=0, example="380 kN m/rad")]
TorsionalDamping = Annotated[float, Quantity("N m s/rad", at_least=0, example="300 N m s/rad")]
Force = Annotated[float, Quantity("N", above=0, example="150 kN")]
Torque = Annotated[float, Quantity("N m", above=0, example="12 kN m")]
Speed = Annotated[float, Quantity("m/s", above=0, example="120 kt")]
Stress = Annotated[float, Quantity("Pa", above=0, example="200 GPa")]
Density = Annotated[float, Quantity("kg/m^3", above=0, example="7850 kg/m^3")]
Damping = Annotated[float, Quantity("N s/m", above=0, example="1e4 N s/m")]
Stiffness = Annotated[float, Quantity("N/m", above=0, example="4 MN/m")]
SecondMoment = Annotated[float, Quantity("m^4", above=0, example="3.4e-6 m^4")]
Rate = Annotated[float, Quantity("1/s", at_least=0, example="0.1 1/s")]
Number = Annotated[float, Quantity("1", above=0)]
Fraction = Annotated[float, Quantity("1", at_least=0)]


class Record(BaseModel):
    """Base of all records: frozen, no unknown keys."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


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

    @model_validator(mode="after")
    def _lateral_of_fifth_order(self) -> Self:
        if self.order == 5 and self.lateral is None:
            raise _refuse("lateral", "missing key", "order 5 needs the block lateral (inertia, stiffness, damping, height)")
        return self


class _Tyre(Record):
    half_contact_length: Length
    relaxation_length: Length
    tread_width_moment: Annotated[float, Quantity("N m^2/rad", at_least=0, example="570 N m^2/rad")] = 0.0


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
    """Straight-tangent tyre: F_y = cornering_stiffness y/sigma, M_z = aligning_stiffness y/sigma, for any load."""

    law: Literal["straight_tangent"]
    cornering_stiffness: Annotated[float, Quantity("N/rad", at_least=0)]
    aligning_stiffness: Annotated[float, Quantity("N m/rad")]


Tyre = Annotated[StringTyre | LinearTyre | StraightTangentTyre, Field(discriminator="law")]


class Damper(Record):
    """Layout of the shimmy damper and level of its geometry.

    `rotational` takes `torsional_stiffness` and `torsional_damping` about the yaw axis as they are.
    """

    topology: Literal["boeing", "utas", "arreaza", "rotational"]
    geometry: Literal["published", "planar"] = "planar"
    torsional_stiffness: TorsionalStiffness | None = None
    torsional_damping: TorsionalDamping | None = None

    @model_validator(mode="after")
    def _given_for_rotational_only(self) -> Self:
        given = [key for key in ("torsional_stiffness", "torsional_damping") if getattr(self, key) is not None]
        if self.topology == "rotational" and len(given) < 2:
            raise _refuse(
                "",
                "topology 'rotational' lacks torsional_stiffness or torsional_damping",
                "both, in N m/rad and N m s/rad",
            )
        if self.topology != "rotational" and given:
            raise _refuse(
                given[0],
                "belongs to topology 'rotational' only",
                f"topology '{self.topology}' takes its stiffness and damping from the design variables",
            )
        return self


class Material(Record):
    """Material of a part; a name from the library or the numbers.

    Metals carry `yield_strength`; a laminate carries `design_strain` instead, and its allowable is E times that strain.
    """

    name: str = "custom"
    youngs_modulus: Stress
    density: Density
    yield_strength: Stress | None = None
    ultimate_strength: Stress | None = None
    design_strain: Annotated[float, Quantity("1", above=0, below=0.1)] | None = None
    fatigue_strength_coefficient: Stress | None = None
    fatigue_exponent: Annotated[float, Quantity("1", above=-1, below=0)] | None = None

    @model_validator(mode="before")
    @classmethod
    def _named(cls, data: Any) -> Any:
        if isinstance(data, str):
            if data not in MATERIALS:
                raise _refuse("", f"'{data}' is no known material", ", ".join(MATERIALS) + ", or the numbers as a mapping")
            return {"name": data, **MATERIALS[data]}
        return data

    @model_validator(mode="after")
    def _complete(self) -> Self:
        if (self.yield_strength is None) == (self.design_strain is None):
            raise _refuse("", "neither or both of yield_strength and design_strain", "exactly one of them")
        if (self.fatigue_strength_coefficient is None) != (self.fatigue_exponent is None):
            raise _refuse("", "half a Basquin law", "fatigue_strength_coefficient and fatigue_exponent together, or neither")
        return self

    @property
    def has_fatigue_data(self) -> bool:
        return self.fatigue_exponent is not None

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {"anyOf": [{"enum": list(MATERIALS)}, handler.resolve_ref_schema(handler(schema))]}


class Range(Record):
    """A closed interval; `min` below `max`."""

    min: float
    max: float

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min < self.max:
            raise _refuse("", f"inverted or empty range: min {self.min:g}, max {self.max:g}", "min < max")
        return self


class SpeedRange(Range):
    """Speed envelope; a single speed is allowed as min = max."""

    min: Speed
    max: Speed

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min <= self.max:
            raise _refuse("", f"inverted range: min {self.min:g}, max {self.max:g} m/s", "min <= max")
        return self


class LoadRange(Range):
    """Continuous range of the vertical load."""

    min: Force
    max: Force


class LengthRange(Range):
    """Range of a length."""

    min: Distance
    max: Length


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
                raise _refuse("vertical_load", "an empty list", "one load or more, or {min, max}")
            if len(set(self.vertical_load)) < len(self.vertical_load):
                raise _refuse("vertical_load", "names a load twice", "different loads")
        return self

    @property
    def loads(self) -> tuple[float, ...]:
        """Vertical loads [N]: the list, or the two ends of the range."""
        load = self.vertical_load
        return (load.min, load.max) if isinstance(load, LoadRange) else tuple(load)

    @property
    def load_is_range(self) -> bool:
        return isinstance(self.vertical_load, LoadRange)


class Fatigue(Record):
    """Fatigue life of the bending arm: `cycles` at `stress_fraction` of the limit-event stress (Basquin)."""

    stress_fraction: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.5
    cycles: Annotated[float, Quantity("1", at_least=1)] = 1e6


class Requirements(Record):
    """What a design must meet; limits are inclusive."""

    stability_margin: Rate
    """Spectral abscissa <= -stability_margin at every speed and load [1/s]."""
    limit_torque: Torque | None = None
    """Yaw torque of the limit event [N m]; left out: limit_torque_factor times the tyre's peak moment."""
    limit_torque_factor: Number = 1.5
    safety_factor: Annotated[float, Quantity("1", at_least=1)] = 1.5
    """On yield strength at the limit event."""
    fatigue: Fatigue = Fatigue()
    apex_clearance: Length = 0.127e-3
    """Free clearance at the apex joint [m]; 0.127 mm is the figure of a 737."""
    stroke_ratio: Number = 10.0
    """Least ratio of the damper's working stroke at the limit event to the apex clearance."""
    lug_distance: LengthRange
    """Allowed distance between the strut lugs, 2 L cos(gamma) [m]."""
    reach: LengthRange
    """Allowed reach of the apex from the strut axis, L sin(gamma) [m]."""
    tyre_clearance: Distance = 0.05
    """Least height of the apex above the top of the tyre [m]."""


class Section(Record):
    """Cross-section family of a beam: one shape at every size.

    tube: wall over outer diameter `thickness_ratio`; rectangle: `aspect_ratio` height over width (bending along the
    height); i_section: `aspect_ratio` height over flange width, `thickness_ratio` flange and web thickness over height.
    """

    family: Literal["solid_round", "tube", "rectangle", "i_section"] = "tube"
    thickness_ratio: Annotated[float, Quantity("1", above=0, below=0.5)] | None = None
    aspect_ratio: Number | None = None

    @model_validator(mode="after")
    def _shape(self) -> Self:
        needs = {
            "solid_round": set(),
            "tube": {"thickness_ratio"},
            "rectangle": {"aspect_ratio"},
            "i_section": {"thickness_ratio", "aspect_ratio"},
        }[self.family]
        given = {key for key in ("thickness_ratio", "aspect_ratio") if getattr(self, key) is not None}
        if given != needs:
            raise _refuse(
                "", f"family '{self.family}' was given {sorted(given) or 'no ratio'}", f"exactly {sorted(needs) or 'no ratio'}"
            )
        if self.thickness_ratio and self.aspect_ratio and self.thickness_ratio * self.aspect_ratio >= 1:
            raise _refuse("", "the web is as wide as the flange", "thickness_ratio * aspect_ratio < 1")
        return self


_TUBE = Section(family="tube", thickness_ratio=0.1)


class MassModel(Record):
    """Numbers of the mass model; the defaults suit a main gear and are explained in the documentation."""

    arm_section: Section = _TUBE
    link_section: Section = _TUBE
    support_section: Section = _TUBE
    cantilever_taper: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.6
    """Mass of a tapered link or support over the prismatic one; 3/5 is exact for uniform stress in one shape."""
    link_fittings_fraction: Fraction = 0.2
    """Lugs, pins and bushings, as a fraction of the mass of links, bending arm and support arm."""
    damper_material: Material = Material.model_validate("AISI 4340")
    """Cylinder, rod, caps and Belleville spring; a metal."""
    working_pressure: Stress = 20.7e6
    """Peak damper pressure at the limit event [Pa] (3000 psi)."""
    dead_length: Length = 0.12
    """Damper length that is not stroke: eyes, glands, piston [m]."""
    wall_allowance: Distance = 2e-3
    """Added to the wall and caps that pressure needs [m]."""
    least_rod_diameter: Length = 0.012
    """Thinnest rod that is made [m]."""
    rod_buckling_factor: Annotated[float, Quantity("1", at_least=1)] = 2.0
    oil_density: Density = 860.0
    damper_fittings_fraction: Fraction = 0.5
    """Eyes, seals, valve and bearings, as a fraction of cylinder, rod and caps."""
    spring_utilisation: Annotated[float, Quantity("1", above=0, at_most=1)] = 0.3
    """Stored energy of a Belleville stack over that of the same volume under uniform stress."""
    lower_lug_height: Coordinate = 0.0
    """Height of the lower torque-link hinge above the wheel axle [m]."""

    @model_validator(mode="after")
    def _damper_is_metal(self) -> Self:
        if self.damper_material.yield_strength is None:
            raise _refuse("damper_material", f"'{self.damper_material.name}' has no yield strength", "a metal")
        return self


class Variable(Record):
    """A design variable: start, min and max, or a single number, which fixes it."""

    start: float
    min: float
    max: float

    @model_validator(mode="before")
    @classmethod
    def _single_number_fixes(cls, data: Any) -> Any:
        return data if isinstance(data, (dict, Variable)) else {"start": data, "min": data, "max": data}

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        if not self.min <= self.start <= self.max:
            raise _refuse(
                "",
                f"inverted range or start outside it: min {self.min:g}, start {self.start:g}, max {self.max:g}",
                "min <= start <= max",
            )
        return self

    @classmethod
    def __get_pydantic_json_schema__(cls, schema: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        block = handler.resolve_ref_schema(handler(schema))
        return {"anyOf": [block["properties"]["start"], block]}


class DampingVariable(Variable):
    """Damping of the damper [N s/m]."""

    start: Damping
    min: Damping
    max: Damping


class StiffnessVariable(Variable):
    """Stiffness of a spring [N/m]."""

    start: Stiffness
    min: Stiffness
    max: Stiffness


class SecondMomentVariable(Variable):
    """Second moment of area [m^4]."""

    start: SecondMoment
    min: SecondMoment
    max: SecondMoment


class LengthVariable(Variable):
    """Length [m]."""

    start: Length
    min: Length
    max: Length


class AngleVariable(Variable):
    """Acute angle [rad]."""

    start: AcuteAngle
    min: AcuteAngle
    max: AcuteAngle


class Design(Record):
    """Bounds and starts of the design variables; a layout needs those of `DESIGN_VARIABLES`, others may stand by."""

    c_lambda: DampingVariable | None = None
    I_arm: SecondMomentVariable | None = None
    k_lambda: StiffnessVariable | None = None
    L: LengthVariable | None = None
    gamma: AngleVariable | None = None
    b: LengthVariable | None = None


class Solver(Record):
    """Numbers of the solution method."""

    starts: Annotated[int, Field(ge=1, le=4096)] = 16
    """Starting points: the config's own and Sobol points within the bounds."""
    seed: Annotated[int, Field(ge=0)] = 1
    tolerance: Annotated[float, Quantity("1", above=0, at_most=1e-4)] = 1e-8
    """Of IPOPT, in scaled variables."""
    margin_reserve: Annotated[float, Quantity("1/s", above=0, at_most=0.1)] = 1e-6
    """Added to the stability margin while solving, so that the exact proof of the margin itself has room [1/s]."""
    verification_speeds: Annotated[int, Field(ge=2, le=1_000_000)] = 2000


class Study(Record):
    """One design study: everything `optimise` and `analyse` need."""

    name: str
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
        topology = self.damper.topology
        missing = [name for name in DESIGN_VARIABLES[topology] if getattr(self.design, name) is None]
        if missing:
            raise _refuse(
                f"design.{missing[0]}",
                "missing key",
                f"topology '{topology}' needs design variables {', '.join(DESIGN_VARIABLES[topology])}",
            )
        if topology in TOPOLOGIES:
            if self.requirements is None:
                raise _refuse("requirements", "missing key", f"topology '{topology}' needs the block requirements")
            if self.requirements.limit_torque is None and self.tyre.law != "nonlinear":
                raise _refuse(
                    "requirements.limit_torque",
                    "missing key",
                    f"a torque: the tyre law '{self.tyre.law}' has no peak to derive it from",
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
        pydantic.ValidationError
            If a key does not exist or the new study is not valid.
        """
        data = self.model_dump()
        for path, value in changes.items():
            *parents, leaf = path.split("__")
            block = data
            for key in parents:
                if block.get(key) is None:
                    block[key] = {}
                block = block[key]
            block[leaf] = value.model_dump() if isinstance(value, BaseModel) else value
        return Study.model_validate(data)


def quantity_of(annotation: Any, metadata: Sequence[Any] = ()) -> Quantity | None:
    """What a field accepts, if it is a number with a unit; optional fields included."""
    for note in (*metadata, *getattr(annotation, "__metadata__", ())):
        if isinstance(note, Quantity):
            return note
    inner = (quantity_of(part) for part in getattr(annotation, "__args__", ()))
    return next((quantity for quantity in inner if quantity), None)


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
