"""What every kind of component must keep, and example studies made of what its fields and variables declare.

A check takes a study, or a component of one, and raises AssertionError with a sentence. Nothing here knows a kind by its name,
but for those of the study that a kind is put into.
"""

from __future__ import annotations

import csv
import itertools
import json
import math
import pickle
from collections.abc import Callable, Iterator, Sequence
from typing import Any, get_args, get_origin

import casadi as ca
import flint
import numpy as np
import pint
import pytest
import yaml
from pydantic import BaseModel, ValidationError

from damperopt import ConfigError, Study, loads
from damperopt.dynamics import build
from damperopt.expressions.corners import Smooth, Switched
from damperopt.expressions.dae import DAE, eliminate
from damperopt.proof.rationals import evaluate
from damperopt.quantities.record import Record, quantity_of
from damperopt.stability.linear import LinearModel
from damperopt.symbols import data_values, symbolic

ROUNDING = 1e-12
"""Relative; one formula evaluated in two ways in double precision."""

CLOSED = 1e-9
"""Relative; what Newton's method on a closed loop leaves, and quotients of it."""

WIDTHS = (1e-4, 1e-6)
"""Parts of the widths of rounded corners, at which the smooth model is compared with the exact one."""

NESTED = 2
"""Corners whose argument has the modes of others, one behind the other, at most."""

SMALL = 1e-3
"""Size of states [SI] at which models are compared: large enough for nonlinear terms, small enough for every linkage."""

BASE = """
name: example
gear: {kind: yaw, yaw_inertia: 20 kg m^2, caster_length: 0.1 m, wheel_radius: 0.35 m}
tyre: {law: arctangent, contact: leading_point, half_contact_length: 0.1 m, relaxation_length: 0.25 m,
       cornering_coefficient: 0.4 1/rad, aligning_coefficient: 0.3 m/rad, aligning_slip_limit: 10 deg}
damper: {topology: boeing, kind: hydraulic}
envelope: {speed: {min: 5 m/s, max: 60 m/s}, vertical_load: 40 kN}
requirements: {stability_margin: 0.5 1/s, lug_distance: {min: 0.3 m, max: 1.2 m}, reach: {min: 0.1 m, max: 0.5 m}}
solver: {starts: 1, verification_speeds: 20}
"""
"""A study that every kind is put into."""

TYRE = {"half_contact_length": "0.1 m", "relaxation_length": "0.25 m"}
"""Numbers that all tyres have."""

WIDE = 30.0
"""Ratio of the bounds of a design variable to its example."""


# examples


class NoExample(AssertionError):
    """A required field declares no example."""


def example(kind: type[BaseModel]) -> dict[str, Any]:
    """Block with what a record requires, each number as its field declares an example."""
    return {name: _example_of(kind, name) for name, field in kind.model_fields.items() if field.is_required()}


def optional(kind: type[BaseModel]) -> dict[str, Any]:
    """Examples of the fields that may be left out; those without one are no numbers, or alternatives of words.

    Of a record that stands for all its defaults, the words that are no default."""
    found = {}
    for name, field in kind.model_fields.items():
        if not field.is_required():
            try:
                found[name] = _example_of(kind, name) or _other_words(type(field.default))
            except NoExample:
                continue
    return found


def _other_words(kind: type[BaseModel]) -> dict[str, str]:
    words = {name: get_args(field.annotation) for name, field in kind.model_fields.items() if _is_choice(field)}
    return {name: alternatives[-1] for name, alternatives in words.items()}


def _is_choice(field: Any) -> bool:
    return get_origin(field.annotation) is not None and all(isinstance(value, str) for value in get_args(field.annotation))


def _example_of(kind: type[BaseModel], name: str) -> Any:
    field = kind.model_fields[name]
    if _is_choice(field):
        return get_args(field.annotation)[0]
    if field.examples:
        return field.examples[0]
    quantity = quantity_of(field.annotation, field.metadata)
    if quantity is not None and quantity.example:
        return float(quantity.example) if quantity.unit == "1" else quantity.example
    if field.examples:
        return field.examples[0]
    for part in (field.annotation, *get_args(field.annotation)):
        if isinstance(part, type) and issubclass(part, BaseModel):
            return example(part)
    raise NoExample(f"{kind.__module__}.{kind.__name__}.{name} declares no example, such as Quantity('m', example='0.6 m')")


def blocks(kind: type[BaseModel], taken: Callable[[dict[str, Any]], bool]) -> list[dict[str, Any]]:
    """The block with the fewest keys that is taken, and the one with the most, if it is another."""
    least, more = example(kind), optional(kind)
    keys = [key for key in more if key not in {"geometry"}]
    choices = (chosen for size in range(len(keys) + 1) for chosen in itertools.combinations(keys, size))
    fewest = next((least | {key: more[key] for key in chosen} for chosen in choices if taken(_with(least, more, chosen))), None)
    assert fewest is not None, f"no study takes {kind.__name__} with the examples of its fields"
    choices = (chosen for size in range(len(keys), -1, -1) for chosen in itertools.combinations(keys, size))
    most = next(_with(least, more, chosen) for chosen in choices if taken(_with(least, more, chosen)))
    return [fewest] if most == fewest else [fewest, most]


def _with(least: dict[str, Any], more: dict[str, Any], chosen: Sequence[str]) -> dict[str, Any]:
    return least | {key: more[key] for key in chosen}


def study_of(**changed: dict[str, Any]) -> Study:
    """The base study with other blocks, read from text as a file is; with bounds about the examples of its design variables."""
    data = yaml.safe_load(BASE) | changed
    try:
        return _read(data)
    except ConfigError as error:
        if not any("limit_torque" in problem for problem in error.problems):
            raise
        data["requirements"] = data["requirements"] | {"limit_torque": "2 kN m"}
        return _read(data)


def _read(data: dict[str, Any]) -> Study:
    from damperopt.study.components import design_variables

    data["design"] = {name: _bounds(variable) for name, variable in design_variables().items()}
    return loads(yaml.safe_dump(data))


def _bounds(variable: Any) -> dict[str, float]:
    from damperopt.quantities.units import Quantity

    assert variable.example, f"design variable '{variable.name}' declares no example"
    start = Quantity(variable.unit)(variable.example)
    most = start * WIDE if variable.below is None else min(start * WIDE, 0.95 * variable.below)
    return {"start": start, "min": start / WIDE, "max": most}


def takes(**changed: Any) -> bool:
    """Whether a study takes these blocks, as the kinds that they name."""
    try:
        study = study_of(**changed)
    except (ConfigError, ValidationError):
        return False
    tags = ("kind", "law", "topology")
    return all(
        getattr(getattr(study, block), tag, value) == value
        for block, keys in changed.items()
        for tag, value in keys.items()
        if tag in tags
    )


# equations


def states_near_rest(dae: DAE, seed: int, size: float = SMALL) -> np.ndarray:
    """States to either side of rest; rates are larger than what they are rates of, as in a motion of some hertz."""
    names = dae.state_names
    scale = np.array([20.0 if name.endswith(("_rate", "_speed")) else 1.0 for name in names])
    return np.random.default_rng(seed).uniform(-1, 1, len(names)) * scale * size


def rates_of(study: Study, corners: Any) -> Callable[[np.ndarray], np.ndarray]:
    """State -> its rates, with every closed loop closed, at a speed and load of the envelope."""
    dae = eliminate(build(symbolic(study), corners))
    function = ca.Function("rates", [dae.x, *dae.parameters], [ca.vertcat(dae.ode, ca.SX(dae.outputs["unclosed"]))])
    point = [list(study.start.values()), *_point(study), data_values(study), 0.0]

    def rates(x: np.ndarray) -> np.ndarray:
        found = function(x, *point).full().ravel()
        assert found[-1] < CLOSED, "the linkage cannot close near rest"
        return found[:-1]

    return rates


def _point(study: Study) -> tuple[float, float]:
    speeds = study.envelope.speed
    return math.sqrt(speeds.min * speeds.max), study.envelope.loads[0]


def rest_is_an_equilibrium(study: Study) -> None:
    """x = 0 stays, but for rounding against the rates of a small motion."""
    for corners in (None, Smooth()):
        dae = build(symbolic(study), corners)
        point = [list(study.start.values()), *_point(study), data_values(study), 0.0]
        function = ca.Function("all", [dae.x, *dae.parameters], [ca.substitute(ca.vertcat(dae.ode, dae.alg), dae.z, dae.rest)])
        moving = np.abs(function(states_near_rest(dae, 1), *point).full()).max()
        resting = np.abs(function(np.zeros(len(dae.states)), *point).full()).max()
        assert resting <= ROUNDING * moving, f"at rest something moves, at {resting:.3g} against {moving:.3g} in motion"


def mirrored_motions_are_motions(study: Study) -> None:
    """f(-x) = -f(x), even states aside, unless a component says that it does not mirror."""
    if not all(getattr(part, name, True) for part in _parts(study) for name in ("MIRRORS", "ODD")):
        return
    dae, rates = build(symbolic(study)), rates_of(study, Smooth())
    mirror = np.array([1.0 if state.even else -1.0 for state in dae.states])
    for seed in range(3):
        x = states_near_rest(dae, seed)
        one, other = rates(x), rates(mirror * x)
        np.testing.assert_allclose(one, mirror * other, rtol=0, atol=CLOSED * np.abs(one).max())


def _parts(study: Study) -> tuple[Any, ...]:
    return study.gear, study.tyre, study.tyre.contact, study.damper


class Narrow(Smooth):
    """Smooth corners with a part of their widths."""

    def __init__(self, part: float):
        self._part = part

    def absolute(self, name: str, x: Any, width: Any) -> Any:
        return super().absolute(name, x, self._part * width)

    def sign(self, name: str, x: Any, width: Any) -> Any:
        return super().sign(name, x, self._part * width)


def smooth_goes_to_exact(study: Study) -> None:
    """With the widths of the corners going to zero, the smooth equations become those with switches."""
    switched = Switched()
    exact = build(symbolic(study), switched)
    modes = [switch.mode for switch in switched.switches.values()]
    sides = [ca.sign(switch.argument) for switch in switched.switches.values()]
    for _ in range(NESTED):
        sides = [ca.substitute(side, ca.vertcat(*modes), ca.vertcat(*sides)) for side in sides]
    with_sides = _equations(exact, [ca.substitute(e, ca.vertcat(*modes), ca.vertcat(*sides)) for e in _rows(exact)])
    errors = []
    for part in WIDTHS:
        narrow = build(symbolic(study), Narrow(part))
        smooth = _equations(narrow, _rows(narrow))
        differences = []
        for seed in range(4):
            # a large motion, so that gaps and stops are passed
            x = states_near_rest(exact, seed, 20 * SMALL)
            z = _unknowns(exact, study, x)
            point = [list(study.start.values()), *_point(study), data_values(study), 0.0]
            one, other = with_sides(x, z, *point).full(), smooth(x, z, *point).full()
            differences.append(np.abs(one - other).max() / np.abs(one).max())
        errors.append(max(differences))
    assert errors[1] < 1e-5, f"the smooth model does not become the exact one: {errors}"
    assert errors[1] <= max(errors[0], ROUNDING), errors


def _rows(dae: DAE) -> list[ca.SX]:
    return [ca.vertcat(dae.ode, dae.alg, *(ca.SX(value) for value in dae.outputs.values()))]


def _equations(dae: DAE, rows: list[ca.SX]) -> ca.Function:
    return ca.Function("equations", [dae.x, dae.z, *dae.parameters], rows)


def _unknowns(dae: DAE, study: Study, x: np.ndarray) -> Any:
    function = ca.Function("guess", [dae.x, dae.design, dae.data], [ca.SX(dae.rest)])
    rest = function(x, list(study.start.values()), data_values(study)).full().ravel()
    return rest + SMALL / 10 * np.arange(1, rest.size + 1)


def declared_powers_are_kept_exactly(study: Study) -> None:
    """The state matrix is a combination of the declared powers of V and F_z: exactly, at points that made none of them."""
    Q, model = flint.fmpq, LinearModel(study)
    design = [Q(*value.as_integer_ratio()) for value in study.start.values()]
    data = [Q(*value.as_integer_ratio()) for value in data_values(study)]

    def matrix(V: Any, F: Any) -> Any:
        return flint.fmpq_mat(evaluate(model.state_matrix, [design, [V], [F], data]))

    load = Q(*study.envelope.loads[0].as_integer_ratio())
    _combination(lambda V: matrix(V, load), model.powers.speed, Q(16), "V")
    if model.powers.load is not None:
        _combination(lambda F: matrix(Q(16), F), model.powers.load, load, "F_z")


def _combination(matrix: Callable[[Any], Any], powers: Sequence[int], about: Any, name: str) -> None:
    Q = flint.fmpq
    points = [about * Q(k + 2, 3) for k in range(len(powers))]
    weights = flint.fmpq_mat([[point**i for i in powers] for point in points]).transpose().inv()
    samples = [matrix(point) for point in points]
    for value in (about * Q(7, 5), about * Q(11, 2)):
        terms = flint.fmpq_mat([[value**i] for i in powers])
        shares = weights * terms
        rebuilt = samples[0] * shares[0, 0]
        for k in range(1, len(points)):
            rebuilt = rebuilt + samples[k] * shares[k, 0]
        assert rebuilt == matrix(value), f"the state matrix holds other powers of {name} than {list(powers)}"


def agrees_with_its_graph(method: Callable[..., Any], *points: Sequence[float]) -> None:
    """A method called with floats gives what its graph gives: numbers, or sequences of numbers, or None in both."""
    symbols = [ca.SX.sym(f"u{i}") for i in range(len(points[0]))]
    made = _flat(method(*symbols))
    graph = ca.Function("graph", symbols, [ca.vertcat(*(ca.SX(value) for value in made))])
    for point in points:
        floats = _flat(method(*map(float, point)))
        assert all(isinstance(value, (bool, int, float)) for value in floats), f"numbers in, {set(map(type, floats))} out"
        expected = graph(*point).full().ravel()
        np.testing.assert_allclose(np.array(floats, float), expected, rtol=1e-11, atol=ROUNDING * np.abs(expected).max())


def _flat(found: Any) -> list[Any]:
    if found is None:
        return []
    if isinstance(found, dict):
        return [value for inner in found.values() for value in _flat(inner)]
    if isinstance(found, (tuple, list)):
        return [value for inner in found for value in _flat(inner)]
    return [found]


# records and files


def record_survives(study: Study) -> None:
    """YAML, JSON and pickle return an equal study."""
    again = loads(yaml.safe_dump(study.model_dump(mode="json", exclude_none=True)))
    assert again == study
    assert Study.model_validate_json(study.model_dump_json(exclude_none=True)) == study
    assert Study.model_validate(json.loads(study.model_dump_json())) == study
    assert pickle.loads(pickle.dumps(study)) == study
    assert study.replace(envelope__speed__max=study.envelope.speed.max + 1) != study


def every_quantity_is_shown(study: Study, motion: Any, file: Any) -> None:
    """Every declared state and output has a unit that pint knows, and a column in the table of a motion."""
    from damperopt.output.tables import write_trajectory

    write_trajectory(file, motion)
    with open(file, encoding="utf-8") as text:
        header, first = next(csv.reader(text)), next(csv.reader(text))
    units = dict(column[:-1].split(" [") for column in header)
    assert len(units) == len(header) == len(first), "a name stands twice in the table"
    registry = _registry()
    for unit in units.values():
        registry.parse_units("" if unit == "1" else unit)
    dae = build(symbolic(study))
    declared = [state for state in dae.states if not state.hidden]
    wheels = 1 + max((int(name.endswith("_right")) for name in dae.state_names), default=0)
    if wheels == 1:
        declared += [*study.gear.OUTPUTS, *study.tyre.OUTPUTS, *study.damper.KIND.OUTPUTS]
    for quantity in declared:
        assert units.get(quantity.name) == quantity.unit, f"{quantity.name} [{quantity.unit}] is not in the table of a motion"


def _registry() -> Any:
    return pint.UnitRegistry()


def peaks_bound(law: Any, load: float) -> None:
    """Force and moment stay below what the law declares as its peaks, over all slips that it is trusted for."""
    peaks = law.peaks(load, law.pressure)
    if peaks is None:
        return
    slips = np.linspace(-law.slip_range, law.slip_range, 4001)
    force = np.abs([law.force(float(alpha), load, law.pressure) for alpha in slips]).max()
    moment = np.abs([law.moment(float(alpha), load, law.pressure, Smooth()) for alpha in slips]).max()
    assert force <= peaks.side_force * (1 + ROUNDING), "the side force passes its peak"
    assert moment <= peaks.aligning_moment * (1 + ROUNDING), "the aligning moment passes its peak"
    if law.ODD:
        for alpha in slips[2001::400]:
            for one, other in (
                (law.force(alpha, load, law.pressure), law.force(-alpha, load, law.pressure)),
                (law.moment(alpha, load, law.pressure, Smooth()), law.moment(-alpha, load, law.pressure, Smooth())),
            ):
                assert math.isclose(one, -other, rel_tol=ROUNDING, abs_tol=ROUNDING * load), "not odd, and does not say so"


def fields_of(kind: type[Record]) -> Iterator[tuple[str, Any]]:
    """Required numbers of a record and of the records in it, with what they declare."""
    for name, field in kind.model_fields.items():
        quantity = quantity_of(field.annotation, field.metadata)
        if quantity is not None and field.is_required():
            yield f"{kind.__name__}.{name}", quantity
        for part in (field.annotation, *get_args(field.annotation)):
            if isinstance(part, type) and issubclass(part, BaseModel):
                yield from fields_of(part)


def with_sizes(expression: Any, sizes: Sequence[Any]) -> float:
    """An expression with the sizes of a damper at their starts."""
    if not sizes or not isinstance(expression, ca.SX):
        return float(expression)
    symbols, starts = ca.vertcat(*(size.symbol for size in sizes)), ca.DM([size.start for size in sizes])
    return float(ca.substitute(expression, symbols, starts))


def once(cases: Sequence[Any]) -> list[Any]:
    """Every case; each kind once in the normal set, its other variants in `make verify`: what a whole run takes, takes long."""
    usual = {case.id for case in least(cases)}
    others = pytest.mark.verify
    return [case if case.id in usual else pytest.param(*case.values, id=case.id, marks=(*case.marks, others)) for case in cases]


def least(cases: Sequence[Any]) -> list[Any]:
    """One case of each kind, by the first word of its name: the last that is not full."""
    return list({case.id.removeprefix("contact ").split()[0]: case for case in cases if "full" not in case.id}.values())
