"""Records of a study: frozen, floats in SI, the same names as the keys of the YAML file.

Every record refuses unknown keys, non-finite numbers and values out of range. `config.load` makes them from a file;
in a notebook they can be made directly or changed with `Study.replace`.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from html import escape
from typing import Any, Self

import yaml
from pydantic import ValidationError, model_validator

from ..errors import ConfigError
from ..linkages.assembly import assemblies
from ..quantities.named import DesignVariable
from ..quantities.record import Name, Record, quantity_of, refuse
from ..reading import printable
from ..strength.materials import Material
from .asked import variables_left_out
from .changes import changed
from .components import DAMPER, GEAR, TYRE
from .envelope import Envelope
from .loads import GroundLoads
from .mass_model import MassModel
from .requirements import Requirements
from .solver import Solver
from .stock import CATALOGUE, Available
from .variables import Design, Variable

__all__ = ["Study", "unit_of"]

LOADS = 17
"""Of a range of loads, at which the tyre is asked whether it has data."""


class Study(Record):
    """One design study: everything `optimise` and `analyse` need."""

    name: Name
    """Of the study; folders and figures carry it."""
    gear: GEAR
    """What moves: inertias, lengths, bending."""
    tyre: TYRE
    """How the ground acts on the wheel: a slip law and a contact line."""
    damper: DAMPER
    """Layout of the shimmy damper, and its kind."""
    material: Material = Material.model_validate("AISI 4340")
    """Of links, bending arm and support arm: a name of the library, or the numbers."""
    envelope: Envelope
    """Speeds and loads at which the requirements hold."""
    requirements: Requirements | None = None
    """What a design must meet; needed where there is something to design."""
    loads: GroundLoads = GroundLoads()
    """Loads of landing and ground handling, and which load cases count."""
    available: Available | None = None
    """Sizes that exist: tubes, walls, bores; left out: any."""
    catalogue: CATALOGUE | None = None
    """Dampers that can be bought: the path of a CSV file, seen from this one, or its rows; left out: one is made."""
    design: Design = Design()
    """Bounds and starts of the design variables."""
    mass: MassModel = MassModel()
    """Numbers of the mass model."""
    solver: Solver = Solver()
    """Numbers of the solution method."""

    @model_validator(mode="after")
    def _complete(self) -> Self:
        self._inflated()
        decay = self.requirements.decay if self.requirements else None
        for i, speed in enumerate(decay.speeds or () if decay else ()):
            low, high = self.envelope.speed.min, self.envelope.speed.max
            if not low <= speed <= high:
                allowed = f"speeds of the envelope, {low:g} to {high:g} m/s"
                raise refuse(f"requirements.decay.speeds.{i}", f"{speed:g} m/s is outside the envelope", allowed)
        cycle = self.requirements.largest_limit_cycle if self.requirements else None
        for i, speed in enumerate(cycle.speeds or () if cycle else ()):
            low, high = self.envelope.speed.min, self.envelope.speed.max
            if not low <= speed <= high:
                allowed = f"speeds of the envelope, {low:g} to {high:g} m/s"
                raise refuse(f"requirements.largest_limit_cycle.speeds.{i}", f"{speed:g} m/s is outside the envelope", allowed)
        for load in self.envelope.samples(LOADS):
            if words := self.beyond_data(load):
                allowed = "loads that tyre and strut have data for"
                raise refuse("envelope.vertical_load", f"{load / 1e3:.6g} kN {words}", allowed)
        self._braked_on_ground()
        self._certain_enough()
        self._controllable()
        topology, names = self.damper.topology, [variable.name for variable in self.damper.VARIABLES]
        missing = [name for name in names if getattr(self.design, name) is None]
        if missing:
            allowed = f"topology '{topology}' needs design variables {', '.join(names)}"
            raise refuse(f"design.{missing[0]}", "missing key", allowed)
        if names:
            if self.requirements is None:
                raise refuse("requirements", "missing key", f"the block requirements, which topology '{topology}' needs")
            if not float(self.loads.limit_torque(self)) > 0:
                raise refuse(
                    "requirements.limit_torque",
                    "missing key",
                    f"a torque, or such a load case: this tyre (law '{self.tyre.law}') has no peak moment to derive it from",
                )
        return self

    def _inflated(self) -> None:
        """Pressures of single wheels are such as the tyre takes, and it asks for one."""
        for key in ("left_pressure", "right_pressure"):
            value = getattr(getattr(self.gear, "axle", None), key, None)
            if value is None:
                continue
            F_z, tyre = max(self.wheel_loads(self.envelope.loads[0])), self.tyre
            try:
                type(tyre).model_validate({**tyre.model_dump(exclude_none=True), "pressure": value})
            except ValidationError as error:
                raise refuse(f"gear.axle.{key}", error.errors()[0]["msg"].partition(";")[0], "as of tyre.pressure") from None
            if tuple(tyre.linear(F_z, value)) == tuple(tyre.linear(F_z, 0.9 * value)):
                allowed = "a tyre that depends on it, by its size or a property file; or left_share alone"
                raise refuse(f"gear.axle.{key}", f"a pressure, which law '{tyre.law}' has no part for", allowed)

    def _braked_on_ground(self) -> None:
        """A steady drag beyond what the tyres can hold is none: the wheels slide."""
        drag, gear = getattr(self.gear, "drag", None), self.gear
        if drag is None:
            return
        for load in self.envelope.samples(LOADS):
            peaks = [tyre.peaks(own, tyre.pressure) for own, tyre in self.on_wheels(load)]
            found = drag.braking(gear.wheel_radius) + drag.rolling(load)
            most = sum(peak.side_force for peak in peaks if peak is not None)
            if None not in peaks and not found < most:
                raise refuse("gear.drag", f"{found:g} N at a load of {load:g} N", f"less than {most:g} N, which the tyres hold")

    def _certain_enough(self) -> None:
        """What uncertain damping does not go with."""
        if self.damper.damping_factors() == (1.0, 1.0):
            return
        key = "damper.damping_range" if self.damper.damping_range is not None else "damper.oil.temperature"
        if self.envelope.load_is_range:
            raise refuse("envelope.vertical_load", f"a range of loads beside {key}", "one load or a list of loads")
        if self.requirements is not None and self.requirements.limit_event == "simulated":
            raise refuse("requirements.limit_event", f"simulated, beside {key}", "torque: its force is that of the cold damper")

    def _controllable(self) -> None:
        """What a control measures and commands."""
        control, damper = self.damper.control, self.damper
        if damper.actuator is None and self.requirements is not None and self.requirements.fail_safe_margin is not None:
            words = "nothing to fail: the proof of the margin has no actuator and no current"
            raise refuse("requirements.fail_safe_margin", words, "stability_margin, or an actuator (damper.control)")
        if control is None:
            return
        known = [state.name for state in (*self.gear.states(), *(self.tyre.states if self.tyre.contact.RATIONAL else ()))]
        if unknown := sorted(control.gains.keys() - set(known)):
            raise refuse(f"damper.control.gains.{unknown[0]}", "no state that can be measured", ", ".join(known))
        if not damper.COMMANDED:
            return
        for key, instead in (("lag", "damper.response_time"), ("limit", "damper.control_current"), ("mass", "mass.damper")):
            if getattr(control, key):
                words = f"a {key} of an actuator, beside kind '{damper.kind}', which the law commands by its current"
                raise refuse(f"damper.control.{key}", words, instead)
        if not damper.control_current:
            raise refuse("damper.control_current", "no current that the law could command", "the most that it may, such as 2 A")

    def wheel_loads(self, load: float) -> tuple[float, ...]:
        """Loads on the wheels [N] at a load on the gear [N]."""
        return tuple(own for own, _ in self.on_wheels(load))

    def on_wheels(self, load: float) -> tuple[tuple[float, Any], ...]:
        """Load [N] and tyre of each wheel at a load on the gear [N]."""
        at_rest = {state.name: 0.0 for state in self.gear.states()}
        wheels = self.gear.wheels(at_rest, self.envelope.speed.max, load)
        return tuple((float(wheel.load), self.tyre.of_wheel(wheel)) for wheel in wheels)

    def beyond_data(self, load: float, stroke: float | None = None) -> str:
        """Why tyre or strut has no answer at a load on the gear [N], and a stroke [m] if it is not in balance; else nothing."""
        strut = "" if self.gear.strut is None else self.gear.strut.beyond(load, stroke)
        return strut or next(filter(None, (tyre.beyond(own, tyre.pressure) for own, tyre in self.on_wheels(load))), "")

    @property
    def variables(self) -> tuple[DesignVariable, ...]:
        """Design variables of damper and layout, in the order of every table and file."""
        variables: tuple[DesignVariable, ...] = self.damper.variables()
        return variables

    @property
    def variable_names(self) -> tuple[str, ...]:
        """Their names."""
        return tuple(variable.name for variable in self.variables)

    @property
    def required(self) -> Requirements:
        """The requirements; every layout that can be optimised has them."""
        if self.requirements is None:
            raise ConfigError(f"{self.name}: requirements: missing key; allowed: the block requirements, with stability_margin")
        return self.requirements

    def without_control(self) -> Study:
        """The study with the damper alone."""
        if self.damper.control is None:
            return self
        given = self.requirements is not None and self.requirements.fail_safe_margin is not None
        return self.replace(damper__control=None, **({"requirements__fail_safe_margin": None} if given else {}))

    @property
    def fail_safe_margin(self) -> float:
        """Margin that the gear keeps with its actuator off [1/s]."""
        given = self.requirements.fail_safe_margin if self.requirements is not None else None
        return 0.0 if given is None else given

    def variable(self, name: str) -> Variable:
        """The design variable `name`, which the layout must have."""
        variable: Variable = self._bounded[name] if name in self._bounded else getattr(self.design, name)
        return variable

    @cached_property
    def _bounded(self) -> dict[str, Variable]:
        """Every design variable; sizes that the study leaves out lie around what strength asks."""
        given = {name: getattr(self.design, name) for name in self.variable_names}
        given = {name: variable for name, variable in given.items() if variable is not None}
        return given | variables_left_out(self, {name: variable.start for name, variable in given.items()})

    @property
    def start(self) -> dict[str, float]:
        """Design at the starts of the layout's design variables [SI]."""
        return {name: self.variable(name).start for name in self.variable_names}

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
        data = self.model_dump(exclude_none=True)
        if "gear__order" in changes:  # an older way to name the kind, which would contradict it
            data["gear"].pop("kind")
        if "requirements__safety_factor" in changes:  # an older name, which the new one would contradict
            data["requirements"].pop("limit_factor")
        topology = changes.get("damper__topology")
        if "damper__kind" not in changes and topology and f"{topology} {data['damper']['kind']}" not in assemblies():
            data["damper"].pop("kind")  # it does not go with the new layout, which has a kind of its own
        if topology:
            data["damper"] = _in_layout(data["damper"], topology)
        data = changed(data, {path.replace("__", "."): value for path, value in changes.items()})
        try:
            return Study.model_validate(data)
        except ValidationError as error:
            raise ConfigError([_problem_in_words(problem) for problem in error.errors(include_url=False)]) from None


def _in_layout(block: dict[str, Any], topology: str) -> dict[str, Any]:
    """A block `damper` without the blocks of words alone, such as the form of a part, that another layout does not know."""
    known = {key for name, made in assemblies().items() if name.split()[0] == topology for key in made.model_fields}
    if not known:
        return block

    def of_words(value: Any) -> bool:
        return isinstance(value, dict) and all(isinstance(inner, str) for inner in value.values())

    return {key: value for key, value in block.items() if key in known or not of_words(value)}


def _problem_in_words(problem: Any) -> str:
    path = [
        *(step for step in problem["loc"] if not str(step).startswith("<")),
        *filter(None, [problem.get("ctx", {}).get("key")]),
    ]
    what = "unknown key" if problem["type"] == "extra_forbidden" else problem["msg"]
    return f"{printable('.'.join(map(str, path)))}: {what}"


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
        record = record[key] if isinstance(record, Mapping) else getattr(record, key)
    field = type(record).model_fields[leaf]
    quantity = quantity_of(field.annotation, field.metadata)
    return quantity.unit if quantity else "1"
