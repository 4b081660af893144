"""Coefficients of the Magic Formula under the names that property files give them, and the curves that they make at a load.

PAC2002 and MF 5.2, pure lateral slip, no camber; of MF 6.1 and 6.2 what these add to it: the exponent PKY4 and the pressure.
Source: Pacejka, Tyre and Vehicle Dynamics, chapter 4.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, TypeAlias

from ..expressions.calculus import Expr, absolute, atan, cos, sin, where
from ..quantities.record import Pressure, Record, Stiffness
from ..quantities.units import Quantity

__all__ = ["OFFSETS", "Coefficients", "Curves"]

Shape: TypeAlias = Annotated[float, Quantity("1", example="1.5")]
Factor: TypeAlias = Annotated[float, Quantity("1", above=0, example="1")]

OFFSETS = (
    *("PHY1", "PHY2", "PVY1", "PVY2", "PEY3"),
    *("QHZ1", "QHZ2", "QDZ6", "QDZ7", "QEZ4"),
)
"""Coefficients that make a tyre pull to one side, or its left and right slip differ: zero where it rolls straight."""


class Coefficients(Record):
    """Coefficients of the Magic Formula; those that are left out are 0, factors 1."""

    FNOMIN: Annotated[float, Quantity("N", at_least=100, at_most=5e6, example="150 kN")]
    """F_z0, nominal load [N]."""
    UNLOADED_RADIUS: Annotated[float, Quantity("m", at_least=0.03, at_most=3, example="0.6 m")]
    """R_0 [m]."""
    PCY1: Annotated[float, Quantity("1", above=0, at_most=2, example="1.3")]
    """C, shape of the side force; at most 2, or it would change its sign."""
    PDY1: Annotated[float, Quantity("1", at_least=-3, at_most=3, example="0.8")]
    """Friction at the nominal load."""
    PDY2: Shape = 0.0
    """Friction, its change with load."""
    PEY1: Annotated[float, Quantity("1", example="-1")] = 0.0
    """Curvature of the side force at the nominal load."""
    PEY2: Shape = 0.0
    """Curvature, its change with load."""
    PEY3: Shape = 0.0
    """Curvature, its difference between left and right slip; an offset."""
    PKY1: Annotated[float, Quantity("1", at_least=-200, at_most=200, example="-15")]
    """Largest cornering stiffness over nominal load [1/rad]; negative in files of ISO axes."""
    PKY2: Annotated[float, Quantity("1", above=0, example="2")]
    """Load over nominal load at which it is largest."""
    PKY4: Annotated[float, Quantity("1", above=0, at_most=4, example="2")] = 2.0
    """Factor of the arctangent in the cornering stiffness; 2 before MF 6.1."""
    PHY1: Shape = 0.0
    """Shift of the slip angle of the side force; an offset [rad]."""
    PHY2: Shape = 0.0
    """Its change with load; an offset [rad]."""
    PVY1: Shape = 0.0
    """Side force over load at zero slip; an offset."""
    PVY2: Shape = 0.0
    """Its change with load; an offset."""
    PTY1: Annotated[float, Quantity("1", above=0, at_most=20, example="1.5")] | None = None
    """Largest relaxation length over R_0."""
    PTY2: Annotated[float, Quantity("1", above=0, example="2")] | None = None
    """Load over nominal load at which it is largest."""
    PPY1: Shape = 0.0
    """Cornering stiffness, its change with pressure."""
    PPY2: Shape = 0.0
    """Load of the largest cornering stiffness, its change with pressure."""
    PPY3: Shape = 0.0
    """Friction, its change with pressure."""
    PPY4: Shape = 0.0
    """Friction, its change with pressure squared."""
    QBZ1: Annotated[float, Quantity("1", example="8")] = 0.0
    """Slope factor of the trail at the nominal load."""
    QBZ2: Shape = 0.0
    """Its change with load."""
    QBZ3: Shape = 0.0
    """Its change with load squared."""
    QBZ9: Shape = 0.0
    """Slope factor of the residual moment."""
    QBZ10: Shape = 0.0
    """Slope factor of the residual moment, share of B C."""
    QCZ1: Annotated[float, Quantity("1", at_least=0, at_most=2, example="1.1")] = 0.0
    """Shape of the trail."""
    QDZ1: Annotated[float, Quantity("1", at_most=1, example="0.1")] = 0.0
    """Trail over R_0 at the nominal load."""
    QDZ2: Shape = 0.0
    """Its change with load."""
    QDZ6: Shape = 0.0
    """Residual moment over load and R_0; an offset."""
    QDZ7: Shape = 0.0
    """Its change with load; an offset."""
    QEZ1: Shape = 0.0
    """Curvature of the trail at the nominal load."""
    QEZ2: Shape = 0.0
    """Its change with load."""
    QEZ3: Shape = 0.0
    """Its change with load squared."""
    QEZ4: Shape = 0.0
    """Its difference between left and right slip; an offset."""
    QHZ1: Shape = 0.0
    """Shift of the slip angle of the trail; an offset [rad]."""
    QHZ2: Shape = 0.0
    """Its change with load; an offset [rad]."""
    PPZ1: Shape = 0.0
    """Trail, its change with pressure."""
    LFZO: Factor = 1.0
    """Factor of the nominal load."""
    LCY: Factor = 1.0
    """Factor of the shape of the side force."""
    LEY: Shape = 1.0
    """Factor of the curvature of the side force."""
    LKY: Factor = 1.0
    """Factor of the cornering stiffness."""
    LHY: Shape = 1.0
    """Factor of the shift of the slip angle."""
    LVY: Shape = 1.0
    """Factor of the side force at zero slip."""
    LMUY: Factor = 1.0
    """Factor of the friction."""
    LTR: Factor = 1.0
    """Factor of the trail."""
    LRES: Shape = 1.0
    """Factor of the residual moment."""
    LSGAL: Factor = 1.0
    """Factor of the relaxation length."""
    LATERAL_STIFFNESS: Stiffness | None = None
    """C_y of the standing tyre; gives the relaxation length K/C_y where PTY1 and PTY2 do not [N/m]."""
    PCFY1: Shape = 0.0
    """Lateral stiffness, its change with load."""
    PCFY2: Shape = 0.0
    """Lateral stiffness, its change with load squared."""
    PCFY3: Shape = 0.0
    """Lateral stiffness, its change with pressure."""
    INFLPRES: Pressure | None = None
    """Pressure of the file; `pressure` of the tyre comes first [Pa]."""
    NOMPRES: Pressure | None = None
    """Pressure at which the coefficients hold as they are [Pa]."""

    def symmetric(self) -> Coefficients:
        """Without the offsets: force and moment are odd in the slip."""
        return self.model_copy(update=dict.fromkeys(OFFSETS, 0.0))

    def _change(self, load: Expr) -> tuple[Expr, Expr]:
        """F_z0' = LFZO F_z0, and (F_z - F_z0')/F_z0'."""
        nominal = self.LFZO * self.FNOMIN
        return nominal, (load - nominal) / nominal

    def _inflation(self, pressure: Expr | None) -> Expr:
        """(p - p_0)/p_0; 0 where nothing is known of p_0."""
        p = self.INFLPRES if pressure is None else pressure
        return 0.0 if p is None or self.NOMPRES is None else (p - self.NOMPRES) / self.NOMPRES

    def relaxation_length(self, load: Expr, pressure: Expr | None) -> Expr | None:
        """sigma = PTY1 sin(2 atan(F_z/(PTY2 F_z0'))) R_0 LFZO LSGAL, or |K|/C_y [m]; None: the coefficients do not give it."""
        nominal, dfz = self._change(load)
        if self.PTY1 is not None and self.PTY2 is not None:
            return self.PTY1 * sin(2 * atan(load / (self.PTY2 * nominal))) * self.UNLOADED_RADIUS * self.LFZO * self.LSGAL
        if self.LATERAL_STIFFNESS is None:
            return None
        dpi = self._inflation(pressure)
        C_y = self.LATERAL_STIFFNESS * (1 + self.PCFY1 * dfz + self.PCFY2 * dfz * dfz) * (1 + self.PCFY3 * dpi)
        return absolute(self.at(load, pressure).K) / C_y

    def at(self, load: Expr, pressure: Expr | None) -> Curves:
        """The curves at a load [N] and a pressure [Pa], in the signs of the file."""
        (nominal, dfz), dpi = self._change(load), self._inflation(pressure)
        most = load / (self.PKY2 * nominal * (1 + self.PPY2 * dpi))
        friction = (self.PDY1 + self.PDY2 * dfz) * (1 + self.PPY3 * dpi + self.PPY4 * dpi * dpi) * self.LMUY
        C, D = self.PCY1 * self.LCY, absolute(friction) * load
        K = self.PKY1 * nominal * (1 + self.PPY1 * dpi) * sin(self.PKY4 * atan(most)) * self.LKY
        return Curves(
            C=C,
            D=D,
            K=K,
            E=(self.PEY1 + self.PEY2 * dfz) * self.LEY,
            E_side=self.PEY3,
            S_H=(self.PHY1 + self.PHY2 * dfz) * self.LHY,
            S_V=load * (self.PVY1 + self.PVY2 * dfz) * self.LVY * self.LMUY,
            B_t=(self.QBZ1 + self.QBZ2 * dfz + self.QBZ3 * dfz * dfz) * self.LKY / self.LMUY,
            C_t=self.QCZ1,
            D_t=load * self.UNLOADED_RADIUS / nominal * (self.QDZ1 + self.QDZ2 * dfz) * (1 - self.PPZ1 * dpi) * self.LTR,
            E_t=self.QEZ1 + self.QEZ2 * dfz + self.QEZ3 * dfz * dfz,
            E_t_side=self.QEZ4,
            S_Ht=self.QHZ1 + self.QHZ2 * dfz,
            B_r=self.QBZ9 * self.LKY / self.LMUY + self.QBZ10 * K / D,
            D_r=load * (self.QDZ6 + self.QDZ7 * dfz) * self.LRES * self.LMUY * self.UNLOADED_RADIUS,
        )


@dataclass(frozen=True)
class Curves:
    """The Magic Formula at one load; expressions, under the letters of its source.

    Attributes
    ----------
    C, D, K, E, E_side, S_H, S_V : Expr
        Of the side force: shape, peak [N], slope [N/rad], curvature and its side, shifts [rad], [N].
    B_t, C_t, D_t, E_t, E_t_side, S_Ht : Expr
        Of the pneumatic trail: D_t [m], shift [rad].
    B_r, D_r : Expr
        Of the residual moment [N m].
    """

    C: Expr
    D: Expr
    K: Expr
    E: Expr
    E_side: Expr
    S_H: Expr
    S_V: Expr
    B_t: Expr
    C_t: Expr
    D_t: Expr
    E_t: Expr
    E_t_side: Expr
    S_Ht: Expr
    B_r: Expr
    D_r: Expr

    def side_angle(self, alpha: Expr) -> Expr:
        """C atan(B a - E (B a - atan(B a))), a = alpha + S_H, B = K/(C D); it grows with alpha where K > 0 [rad]."""
        a = alpha + self.S_H
        Ba = self.K / (self.C * self.D) * a
        E = _at_most_one(self.E * (1 - self.E_side * where(a < 0, -1.0, 1.0)))
        return self.C * atan(Ba - E * (Ba - atan(Ba)))

    def side_force(self, alpha: Expr) -> Expr:
        """F_y = D sin(side_angle) + S_V [N]."""
        return self.D * sin(self.side_angle(alpha)) + self.S_V

    def trail(self, alpha: Expr) -> Expr:
        """t = D_t cos(C_t atan(B_t a - E_t (B_t a - atan(B_t a)))) cos(alpha), a = alpha + S_Ht [m]."""
        Ba = self.B_t * (alpha + self.S_Ht)
        E_t = _at_most_one(self.E_t * (1 + self.E_t_side * 0.6366197723675814 * atan(self.C_t * Ba)))  # 2/pi
        return self.D_t * cos(self.C_t * atan(Ba - E_t * (Ba - atan(Ba)))) * cos(alpha)

    def moment(self, alpha: Expr) -> Expr:
        """M_z = -t F_y + D_r cos(atan(B_r a)) cos(alpha), a = alpha + S_H + S_V/K, in the signs of the file [N m]."""
        a = alpha + self.S_H + self.S_V / self.K
        return -self.trail(alpha) * self.side_force(alpha) + self.D_r * cos(atan(self.B_r * a)) * cos(alpha)


def _at_most_one(E: Expr) -> Expr:
    return where(E < 1, E, 1.0)
