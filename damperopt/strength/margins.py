"""Margins of safety: what a part bears over what it has to bear, less one, for each part, check and case.

MS = allowable/(applied factor) - 1, at limit load (yield) and at ultimate load (rupture, buckling, bearing). The functions of
strength are plain formulas in floats or symbols; what they leave out stands in their text.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any, Literal

from ..expressions.calculus import Expr, exp, sqrt, where
from .fatigue import Basquin, stress_margin
from .materials import bearing_strength, shear_strength, ultimate_stress

__all__ = [
    "Column",
    "Lug",
    "Margin",
    "bolt_margin",
    "column_margins",
    "column_stress",
    "critical",
    "euler_load",
    "fatigue_margin",
    "lug_margins",
    "margin_of_safety",
    "stress_margins",
    "wall_buckling_stress",
]

Level = Literal["limit", "ultimate", "life"]


def margin_of_safety(allowable: Expr, applied: Expr, factor: Expr = 1.0) -> Expr:
    """MS = allowable/(applied factor) - 1; infinite where nothing is applied.

    Parameters
    ----------
    allowable, applied : Expr
        Of one unit, magnitudes.
    factor : Expr
        On what is applied.

    Examples
    --------
    >>> round(margin_of_safety(1103e6, 735e6), 4), round(margin_of_safety(1172e6, 735e6, 1.5), 4)
    (0.5007, 0.063)
    """
    if isinstance(applied, (int, float)) and applied == 0:
        return math.inf
    return allowable / (applied * factor) - 1


@dataclass(frozen=True)
class Margin:
    """A check of a part under a load case; expressions.

    Attributes
    ----------
    part, check, case : str
        Such as ``bending arm``, ``yield``, ``side_load``.
    level : str
        ``limit``, ``ultimate``, or ``life`` for fatigue.
    applied, allowable : Expr
        At limit load, and what the part bears [`unit`].
    factor : Expr
        From limit load to the level of the check.
    unit : str
    """

    part: str
    check: str
    case: str
    level: Level
    applied: Expr
    allowable: Expr
    factor: Expr = 1.0
    unit: str = "Pa"

    @property
    def value(self) -> Expr:
        """MS [1]; negative where the part fails the check."""
        return margin_of_safety(self.allowable, self.applied, self.factor)

    def __str__(self) -> str:
        return f"{self.part}, {self.check} at {self.level} load, {self.case}: MS {self.value:+.2f}"


def critical(margins: Iterable[Margin]) -> list[Margin]:
    """The least margin of each part, the least of all first.

    Parameters
    ----------
    margins : iterable of Margin
        Floats.
    """
    least: dict[str, Margin] = {}
    for margin in margins:
        if margin.part not in least or margin.value < least[margin.part].value:
            least[margin.part] = margin
    return sorted(least.values(), key=lambda margin: margin.value)


def stress_margins(part: str, case: str, stress: Expr, material: Any, factors: tuple[Expr, Expr] = (1.0, 1.5)) -> list[Margin]:
    """Yield at limit and rupture at ultimate load; a laminate has its design strain at ultimate load alone.

    Parameters
    ----------
    part, case : str
    stress : Expr
        At limit load [Pa].
    material : Material
    factors : tuple of Expr
        On yield at limit load, and ultimate over limit load.
    """
    limit, ultimate = factors
    rupture = "rupture" if material.design_strain is None else "design strain"
    found = [Margin(part, rupture, case, "ultimate", stress, ultimate_stress(material), ultimate)]
    if material.yield_strength is not None:
        found.insert(0, Margin(part, "yield", case, "limit", stress, material.yield_strength, limit))
    return found


def euler_load(youngs_modulus: Expr, inertia: Expr, length: Expr) -> Expr:
    """Euler load of a column with pinned ends [N], pi^2 E I/l^2.

    Parameters
    ----------
    youngs_modulus, inertia, length : Expr
        [Pa], [m^4], [m].
    """
    return math.pi**2 * youngs_modulus * inertia / length**2


def column_stress(euler_stress: Expr, yield_strength: Expr) -> Expr:
    """Stress at which a pinned column fails [Pa]: Euler's up to half the yield strength, Johnson's parabola beyond.

    Johnson: sigma_y (1 - sigma_y/(4 sigma_E)); both and their slopes are equal at sigma_E = sigma_y/2.

    Parameters
    ----------
    euler_stress : Expr
        Euler load over area [Pa].
    yield_strength : Expr
        In compression, for which that in tension stands [Pa].
    """
    johnson = yield_strength * (1 - yield_strength / (4 * euler_stress))
    return where(euler_stress < yield_strength / 2, euler_stress, johnson)


def wall_buckling_stress(
    youngs_modulus: Expr, radius: Expr, wall: Expr, poissons_ratio: Expr = 0.3, load: Literal["axial", "bending"] = "axial"
) -> Expr:
    """Elastic stress at which the wall of a round tube buckles [Pa]: the classical one, knocked down (NASA SP-8007).

    gamma E/sqrt(3 (1 - nu^2)) t/r with gamma = 1 - k (1 - exp(-sqrt(r/t)/16)), k 0.901 for axial load and 0.731 for bending.
    Where it is above the yield strength, yield is first.

    Parameters
    ----------
    youngs_modulus : Expr
        [Pa]
    radius, wall : Expr
        To the middle of the wall, and its thickness [m].
    poissons_ratio : Expr
    load : str
    """
    k = {"axial": 0.901, "bending": 0.731}[load]
    gamma = 1 - k * (1 - exp(-sqrt(radius / wall) / 16))
    return gamma * youngs_modulus / sqrt(3 * (1 - poissons_ratio**2)) * wall / radius


@dataclass(frozen=True)
class Column:
    """A column with pinned ends; expressions.

    Attributes
    ----------
    area, inertia, length : Expr
        [m^2], [m^4], [m].
    radius, wall : Expr or None
        Of a round tube, to the middle of its wall, and the wall's thickness [m]; None: no wall that buckles by itself.
    """

    area: Expr
    inertia: Expr
    length: Expr
    radius: Expr = None
    wall: Expr = None


@dataclass(frozen=True)
class Lug:
    """A lug about a pin: bore D, thickness t, width W, distance e of the bore's centre from the free end [m]; expressions."""

    bore: Expr
    thickness: Expr
    width: Expr
    edge: Expr


def lug_margins(
    part: str, case: str, force: Expr, lug: Lug, material: Any, factors: tuple[Expr, Expr] = (1.5, 1.0)
) -> list[Margin]:
    """Bearing, shear-out and net tension of a lug at ultimate load.

    Shear-out on two planes of length e - D/2, the shortest; net tension without stress concentration, as a
    ductile metal ruptures. Bearing strengths are for edge distances of 1.5 bores and more, which `mass.lug` asks of its eyes.

    Parameters
    ----------
    part, case : str
    force : Expr
        Along the lug, at limit load [N].
    lug : Lug
    material : Material
    factors : tuple of Expr
        Ultimate over limit load, and a fitting factor beside it.
    """
    ultimate, fitting = factors
    factor = ultimate * fitting
    shear = force / (2 * lug.thickness * (lug.edge - lug.bore / 2))
    tension = force / ((lug.width - lug.bore) * lug.thickness)
    return [
        Margin(part, "bearing", case, "ultimate", force / (lug.bore * lug.thickness), bearing_strength(material), factor),
        Margin(part, "shear-out", case, "ultimate", shear, shear_strength(material), factor),
        Margin(part, "net tension", case, "ultimate", tension, ultimate_stress(material), factor),
    ]


def bolt_margin(part: str, case: str, force: Expr, diameter: Expr, material: Any, ultimate_factor: Expr = 1.5) -> Margin:
    """Pin in double shear at ultimate load: half the force on each of two sections; its bending is left out.

    Parameters
    ----------
    part, case : str
    force : Expr
        At limit load [N].
    diameter : Expr
        [m]
    material : Material
    ultimate_factor : Expr
    """
    shear = force / 2 / (math.pi / 4 * diameter**2)
    return Margin(part, "double shear", case, "ultimate", shear, shear_strength(material), ultimate_factor)


def column_margins(
    part: str, case: str, force: Expr, section: Column, material: Any, ultimate_factor: Expr = 1.5
) -> list[Margin]:
    """Column, and wall of a tube, at ultimate load.

    Parameters
    ----------
    part, case : str
    force : Expr
        Along the column in compression, at limit load [N].
    section : Column
    material : Material
    ultimate_factor : Expr
    """
    stress = force / section.area
    euler = euler_load(material.youngs_modulus, section.inertia, section.length) / section.area
    strength = material.yield_strength if material.design_strain is None else ultimate_stress(material)
    found = [Margin(part, "column", case, "ultimate", stress, column_stress(euler, strength), ultimate_factor)]
    if section.wall is not None:
        wall = wall_buckling_stress(material.youngs_modulus, section.radius, section.wall, material.poissons_ratio)
        found.append(Margin(part, "wall", case, "ultimate", stress, wall, ultimate_factor))
    return found


def fatigue_margin(part: str, damage: Expr, law: Basquin) -> Margin:
    """Of the stresses of a life: at 1 + MS times them the damage, scatter factor included, would be 1.

    Parameters
    ----------
    part : str
    damage : Expr
        Of the life, scatter factor included, above 0.
    law : Basquin
    """
    return Margin(part, "fatigue", "spectrum", "life", 1.0, 1 + stress_margin(damage, law), unit="1")
