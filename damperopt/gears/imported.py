"""The gear whose structure comes as matrices, from a finite-element model or a test: any number of coordinates.

M q'' + (C + G V) q' + (K + K_g F_z + K_D D) q = B_F F_y - B_M (M_z + kappa theta'/V - D w) + H_d' T, with the lateral position
of the contact centre eta = H_eta q and the swivel of the wheel theta = H_theta q. Small motions of the structure; the tyre
stays nonlinear.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import ConfigDict, Field, ValidationError, ValidationInfo, model_validator

from ..expressions.calculus import Expr
from ..expressions.corners import Corners
from ..ports.motion import Attachment, Motion, Torque
from ..ports.wheel import Contact, Wheel
from ..quantities.named import Output, State
from ..quantities.record import Coordinate, Inertia, Name, Record, refuse
from .base import Gear, Names
from .drag import Dragged, deflected
from .friction import friction_torque
from .matrices import read, refuse_wrong
from .yaw import Yaw

__all__ = ["Imported", "Structure"]

Row = tuple[float, ...]
Matrix = tuple[Row, ...]

AGREES = 1e-9
"""Relative; how closely a number that stands beside the matrices must agree with them."""


def _example(*values: Any) -> Any:
    return Field(examples=list(values))


def _file_or_numbers(schema: dict[str, Any]) -> None:
    """In the JSON Schema: the numbers, or the file that holds them."""
    words = "A .npz, or a folder with a .csv for each of M, C, K, H_eta, H_theta, ...; in the place of all other keys."
    schema["properties"]["file"] = {"type": "string", "description": words}
    schema["anyOf"] = [{"required": schema.pop("required")}, {"required": ["file"]}]


class Structure(Record):
    """Matrices of n coordinates q of any kind and unit, energies in J; given here, or read from ``file``."""

    model_config = ConfigDict(json_schema_extra=_file_or_numbers)

    M: Annotated[Matrix, _example([[20.0, 0.5], [0.5, 200.0]])]
    """Inertia (n, n), symmetric and positive definite."""
    C: Annotated[Matrix, _example([[0.0, 0.0], [0.0, 50.0]])]
    """Damping (n, n), symmetric."""
    K: Annotated[Matrix, _example([[0.0, 0.0], [0.0, 1e6]])]
    """Stiffness (n, n), symmetric, without that of the damper's linkage."""
    H_eta: Annotated[Row, _example([-0.1, -1.5])]
    """eta = H_eta q, lateral position of the contact centre in the direction of the side force (n,) [m]."""
    H_theta: Annotated[Row, _example([1.0, 0.0])]
    """theta = H_theta q, swivel of the wheel plane (n,) [rad]."""
    G: Matrix | None = None
    """Gyroscopic (n, n), antisymmetric, per speed."""
    K_g: Matrix | None = None
    """Stiffness that the vertical load makes (n, n), per newton."""
    K_D: Matrix | None = None
    """Stiffness that a drag in the plane of the wheel makes (n, n), per newton; needed where the gear has a drag."""
    B_F: Row | None = None
    """Generalised force of a unit side force (n,); left out: H_eta, right where the strut has no rake."""
    B_M: Row | None = None
    """Generalised force, turned around, of a unit aligning moment (n,); left out: H_theta, right without rake."""
    H_d: Row | None = None
    """Angle H_d q that linkage and damper feel (n,) [rad]; left out: the swivel."""
    names: tuple[Name, ...] | None = None
    """Of the coordinates, for modes."""
    source: Name | None = None
    """File that the numbers were read from."""

    @model_validator(mode="before")
    @classmethod
    def _read(cls, data: Any, info: ValidationInfo) -> Any:
        if not isinstance(data, dict) or "file" not in data:
            return data
        if len(data) > 1 or not isinstance(data["file"], str):
            raise refuse("file", "numbers beside a file" if len(data) > 1 else "no name of a file", "file: alone, with a path")
        folder = Path((info.context or {}).get("folder", "."))
        return {**read(folder / data["file"]), "source": data["file"]}

    @model_validator(mode="after")
    def _sound(self) -> Self:
        refuse_wrong(self.model_dump(exclude={"source"}))
        if self.names is not None and (len(self.names) != len(self.M) or len(set(self.names)) < len(self.names)):
            raise refuse(
                "names", f"{len(self.names)} names, {len(set(self.names))} of them different", f"{len(self.M)}, each once"
            )
        return self


class Imported(Gear):
    """Structure of any number of coordinates as matrices M, C, K, from a finite-element model or a test."""

    OUTPUTS: ClassVar[tuple[Output, ...]] = (
        *Yaw.OUTPUTS,
        Output("lateral_displacement", "m", "of the contact centre by the structure, -H_eta q"),
    )
    STATES: ClassVar[tuple[State, ...]] = Yaw.STATES
    STROKES: ClassVar[bool] = False

    kind: Literal["imported"]
    yaw_inertia: Inertia | None = None  # type: ignore[assignment]  # always filled in from the matrices
    """I_z, 1/(H_theta M^-1 H_theta'): follows from the matrices [kg m^2]."""
    caster_length: Coordinate | None = None  # type: ignore[assignment]  # as above
    """Lever of the side force on the yaw: follows from the matrices [m]."""
    drag: Dragged = None
    """Steady braking and rolling drag, by K_D of the structure; left out: the wheel rolls freely."""
    structure: Structure
    """M, C, K, H_eta, H_theta, optionally G, K_g, K_D, B_F, B_M, H_d, names; or ``file``: a .npz, or a folder of .csv."""

    @model_validator(mode="before")
    @classmethod
    def _from_matrices(cls, data: Any, info: ValidationInfo) -> Any:
        """Inertia and caster, which other gears give and loads are estimated with, follow from the matrices."""
        if not isinstance(data, dict) or "structure" not in data:
            return data
        try:
            structure = Structure.model_validate(data["structure"], context=info.context)
        except ValidationError:
            return data  # the field says what is wrong
        inertia, caster = _Coordinates(structure).inertia_and_caster
        follows = {"yaw_inertia": inertia, "caster_length": caster, "rake_angle": 0.0}
        for key, value in follows.items():
            given = data.get(key, value)
            if not isinstance(given, (int, float)) or abs(given - value) > AGREES * max(abs(value), 1e-9):
                raise refuse(key, f"found {given} beside matrices that say {value:g}", "to leave it out")
        return {**data, **follows, "structure": structure}

    @model_validator(mode="after")
    def _drag_has_a_matrix(self) -> Self:
        if self.drag is not None and self.structure.K_D is None:
            raise refuse("structure.K_D", "missing key", "the stiffness per newton of drag, which gear.drag needs")
        return self

    def states(self) -> tuple[State, ...]:
        """Yaw, which is H_theta q, in the place of the coordinate with the largest part in it; then what does not yaw."""
        at = _Coordinates(self.structure)
        found = list(Yaw.STATES)
        for i, name in enumerate(at.names[1:], 1):
            label = f"coordinate_{at.order[i] + 1}"
            found += [State(label, "1", name, f"{label}_rate", True), State(f"{label}_rate", "1/s", name, label, True)]
        return tuple(found)

    def wheels(self, x: Names, speed: Expr, load: Expr) -> tuple[Wheel, ...]:
        """One wheel, moved by the coordinates."""
        at = _Coordinates(self.structure)
        p, p_t = self._coordinates(x)
        swivel, swivel_rate, lateral, lateral_rate = (_dot(row, v) for row in (at.H_theta, at.H_eta) for v in (p, p_t))
        return (Wheel(speed, swivel, swivel_rate, lateral, lateral_rate, self.caster_length, load),)

    def rates(self, x: Names, contacts: Sequence[Contact], damper: Torque, yaw_torque: Expr, corners: Corners) -> Motion:
        """M p'' = -(C + G V) p' - (K + K_g F_z + K_D D) p + B_F F_y - B_M (M_z - D w) + H_d' T + H_theta' (T_yaw - T_dry)."""
        at, (contact,) = _Coordinates(self.structure), contacts
        wheel, (p, p_t) = contact.wheel, self._coordinates(x)
        assert wheel is not None
        turned_on, pulled = deflected(self.drag, contact, self.wheel_radius), 0
        if self.drag is not None:
            pulled = self.drag.braking(self.wheel_radius) + self.drag.rolling(wheel.load)
        rubs = friction_torque(self.friction, wheel.swivel_rate, corners)
        drives = []
        for i in range(len(p)):
            force = at.B_F[i] * contact.side_force - at.B_M[i] * (contact.aligning_moment - turned_on)
            force += at.H_d[i] * damper.torque + at.H_theta[i] * yaw_torque
            force -= _dot(at.C[i], p_t) + _dot(at.K[i], p)
            force -= _dot(at.G[i], p_t) * wheel.speed + _dot(at.K_g[i], p) * wheel.load + _dot(at.K_D[i], p) * pulled
            drives.append(force)
        free = [_dot(row, drives) for row in at.flexibility]
        slowed = [a - _dot(row, at.H_theta) * rubs for row, a in zip(at.flexibility, free, strict=True)]
        names = [state.name for state in self.states()]
        rates = dict(zip(names[::2], p_t, strict=True)) | dict(zip(names[1::2], slowed, strict=True))
        outputs = {
            "linkage_torque": damper.torque,
            "torque_without_friction": self.yaw_inertia * free[0],
            "lateral_displacement": -wheel.lateral,
        }
        return Motion(rates, outputs)

    def lever(self) -> Expr:
        """Generalised force of a unit side force on the yaw, turned around [m]."""
        return self.caster_length

    def attachments(self, x: Names) -> dict[str, Attachment]:
        """``damper`` at the angle H_d q."""
        at, (p, p_t) = _Coordinates(self.structure), self._coordinates(x)
        rates = [state.name for state in self.states()][1::2]
        row = {name: value for name, value in zip(rates, at.H_d, strict=True) if value}
        return {"damper": Attachment(_dot(at.H_d, p), _dot(at.H_d, p_t), row)}

    def leaves_out(self) -> tuple[str, ...]:
        """What matrices of small motion cannot hold."""
        return ("large motion of the structure: its matrices are those of small motion (gear.structure)", *super().leaves_out())

    def _coordinates(self, x: Names) -> tuple[list[Expr], list[Expr]]:
        names = [state.name for state in self.states()]
        return [x[name] for name in names[::2]], [x[name] for name in names[1::2]]


class _Coordinates:
    """The structure in coordinates p whose first is the yaw H_theta q: q = T p, forces by T'.

    The first column is the shape that a yaw torque accelerates, t = M^-1 H_theta' I_z; the others do not yaw, and inertia does
    not couple them with it. So a kick in yaw is the same motion in whatever coordinates the matrices come.
    """

    def __init__(self, structure: Structure):
        self._given = structure
        theta = np.array(structure.H_theta)
        shape = np.linalg.solve(np.array(structure.M), theta)
        shape /= theta @ shape
        first = int(np.abs(theta * shape).argmax())
        n = len(theta)
        self.order = [first, *(i for i in range(n) if i != first)]
        self.names = [structure.names[i] if structure.names else f"coordinate {i + 1}" for i in self.order]
        still = np.eye(n) - np.outer(shape, theta)
        self._T = np.column_stack([shape, still[:, self.order[1:]]])

    def _square(self, matrix: Matrix | None) -> np.ndarray:
        return self._T.T @ np.array(matrix) @ self._T if matrix is not None else np.zeros_like(self._T)

    def _row(self, row: Row | None, otherwise: Row) -> np.ndarray:
        return np.asarray(np.array(otherwise if row is None else row) @ self._T)

    @cached_property
    def C(self) -> np.ndarray:
        return self._square(self._given.C)

    @cached_property
    def G(self) -> np.ndarray:
        return self._square(self._given.G)

    @cached_property
    def K(self) -> np.ndarray:
        return self._square(self._given.K)

    @cached_property
    def K_g(self) -> np.ndarray:
        return self._square(self._given.K_g)

    @cached_property
    def K_D(self) -> np.ndarray:
        return self._square(self._given.K_D)

    @cached_property
    def H_eta(self) -> np.ndarray:
        return self._row(self._given.H_eta, ())

    @cached_property
    def H_theta(self) -> np.ndarray:
        return np.eye(len(self._T))[0]

    @cached_property
    def B_F(self) -> np.ndarray:
        return self._row(self._given.B_F, self._given.H_eta)

    @cached_property
    def B_M(self) -> np.ndarray:
        return self._row(self._given.B_M, self._given.H_theta)

    @cached_property
    def H_d(self) -> np.ndarray:
        return self._row(self._given.H_d, self._given.H_theta)

    @cached_property
    def flexibility(self) -> np.ndarray:
        """M^-1."""
        return np.linalg.inv(self._square(self._given.M))

    @property
    def inertia_and_caster(self) -> tuple[float, float]:
        """What a yaw torque feels, 1/(H_theta M^-1 H_theta'), and the lever of the side force on the yaw."""
        return float(1 / self.flexibility[0, 0]), float(-self.B_F[0])


def _dot(row: Any, values: Any) -> Expr:
    """Sum of products, without those that are zero."""
    return sum((float(c) * value for c, value in zip(row, values, strict=True) if c), 0.0)
