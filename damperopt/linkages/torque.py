"""Torque of a damper on the gear: the linkage with everything that stands in series or in parallel with it.

From the gear to the damper: the angle of the attachment (yaw psi), apex freeplay, torque links of stiffness k_t (at the apex,
laterally; thesis (3-14)), the linkage at its own angle psi_l with spring or arm, end stop and damper, and in series with the
damper the stiffness k_s of oil column, rod and brackets. Torques by virtual work.

The nodes between are massless, so that each either follows from a first-order equation (psi_l where the damper is rigidly
attached, the dashpot's own stroke where it is not) or is an algebraic unknown (psi_l with both compliances).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, ClassVar

from ..dampers.base import Context
from ..expressions.calculus import Expr, symbol
from ..expressions.corners import Corners
from ..ports.linkage import Linkage
from ..ports.motion import Attachment, Torque
from ..quantities.named import Output, State
from .joints import beyond_gap, stop_force

__all__ = ["CHAIN_STATES", "OUTPUTS", "ROTARY_OUTPUTS", "damper_torque"]

RATE_STEPS = 24
"""Of Newton's method for the rate of a damper without an inverse: the first-order guess lies far outside where the force grows
with a high power p of the rate, and each step then takes 1/p off."""

CHAIN_STATES = (
    State("dashpot_stroke", "m", "damper"),
    State("link_angle", "rad", "damper"),
    State("dashpot_angle", "rad", "damper"),
)
"""States that compliances add; the last is that of a rotary damper."""

OUTPUTS = (
    Output("damper_stroke", "m", "from rest"),
    Output("damper_speed", "m/s"),
    Output("damper_force", "N", "against the stroke"),
    Output("spring_deflection", "m", "of the spring, or of the tip of the bending arm"),
    Output("spring_force", "N"),
    Output("stop_force", "N", "of the end stop"),
)
"""What a linkage shows."""

ROTARY_OUTPUTS = (
    Output("damper_angle", "rad", "from rest"),
    Output("damper_rate", "rad/s"),
    Output("damper_torque", "N m", "against the motion"),
    Output("spring_angle", "rad"),
    Output("spring_torque", "N m"),
)
"""The same where spring and damper act about the yaw axis itself."""


def damper_torque(
    damper: Any, link: Linkage, design: Mapping[str, Expr], corners: Corners, attachment: Attachment, context: Context
) -> Torque:
    """Torque of `link`, with the joints and compliances of `damper`, on a gear.

    Parameters
    ----------
    damper : Assembly
        Floats or symbols.
    link : Linkage
    design : mapping of str to Expr
        Design variables by name [SI].
    corners : Corners
        Version of the nonlinear elements.
    attachment : Attachment
        Angle [rad] and rate [rad/s] that the gear gives.
    context : Context

    Returns
    -------
    Torque
    """
    return _Chain(damper, link, {**design, **link.as_printed}, corners, attachment, context).torque()


class _Chain:
    """One chain from the gear to the damper, as it is being written down."""

    states: ClassVar = {state.name: state for state in CHAIN_STATES}

    def __init__(
        self, damper: Any, link: Linkage, design: Mapping[str, Expr], corners: Corners, attachment: Attachment, context: Context
    ):
        self._damper, self._link, self._design = damper, link, design
        self._corners, self._attachment, self._context = corners, attachment, context
        self._own = {state.name: symbol(state.name) for state in damper.STATES}
        self._unknowns: list[tuple[Expr, Expr, Expr]] = []  # symbol, value at rest, residual
        self._newton_steps: int | None = None

    def torque(self) -> Torque:
        """The four cases: with and without compliance of the links (k_t) and in series with the damper (k_s)."""
        damper, link = self._damper, self._link
        k_t, k_s = damper.links(self._design), damper.series(self._design)
        psi, psi_t = self._attachment.angle, self._attachment.rate
        driving, engaged = psi, 1
        if k_t is not None:
            driving = symbol("link_angle")
        elif damper.play is not None:
            driving, engaged = beyond_gap(damper.play, link.reach, self._corners, psi)
        position = link.at(driving)
        s, lever = position.stroke, position.damper_lever
        F_spring, F_stop = link.stiffness * position.deflection, stop_force(damper.stop, self._corners, s)
        elastic = F_spring * position.spring_lever + F_stop * lever
        chain: dict[str, tuple[Expr, Expr]] = {}  # state: symbol, rate
        through = None if k_t is None else self._through_links(k_t, psi - driving)

        if k_s is not None:
            name = "dashpot_angle" if damper.ROTARY else "dashpot_stroke"
            dashpot = symbol(name)
            F_d = k_s * (s - dashpot)
            v = self._speed(dashpot, F_d)
            chain[name] = dashpot, v
            if k_t is not None:  # in units of an angle, as the unknown is
                self._unknowns.append((driving, 0, (through - elastic - F_d * lever) / (k_t * link.reach**2)))
        elif k_t is not None:
            F_d = (through - elastic) / lever
            v = self._speed(s, F_d)
            chain["link_angle"] = driving, v / lever
        else:
            v = engaged * lever * psi_t
            F_d = self._force(s, v).force
        torque = -engaged * (elastic + F_d * lever) if through is None else -through

        own = self._force(s if k_s is None else dashpot, v)
        rates = {name: rate for name, (_, rate) in chain.items()} | dict(own.rates)
        closure, unknowns = link.closure(driving), self._unknowns
        shown = (s, v, F_d, position.deflection, F_spring, F_stop)
        names = ROTARY_OUTPUTS if damper.ROTARY else OUTPUTS
        return Torque(
            torque,
            {name: x for name, (x, _) in chain.items()} | self._own,
            rates,
            (*link.unknowns, *(unknown for unknown, _, _ in unknowns)),
            (*link.rest, *(rest for _, rest, _ in unknowns)),
            (*closure, *(residual for _, _, residual in unknowns)),
            dict(zip((o.name for o in names), shown, strict=False)) | dict(own.outputs),
            self._newton_steps,
        )

    def _through_links(self, k_t: Expr, twist: Expr) -> Expr:
        """Torque through elastic links [N m]; the play stands in series with them."""
        if self._damper.play is not None:
            twist, _ = beyond_gap(self._damper.play, self._link.reach, self._corners, twist)
        return k_t * self._link.reach**2 * twist

    def _force(self, stroke: Expr, rate: Expr) -> Any:
        return self._damper.force(self._design, self._own, stroke, rate, self._context, self._corners)

    def _speed(self, stroke: Expr, force: Expr) -> Expr:
        """Rate of the damper at a force: in closed form, or as an unknown whose equation is the force itself."""
        rate = self._damper.rate(self._design, self._own, stroke, force, self._context, self._corners)
        if rate is None:
            rate, self._newton_steps = symbol("damper_speed"), RATE_STEPS
            damping = self._damper.damping(self._design)  # a symbol has no truth
            scale = 1.0 if damping is None else damping
            self._unknowns.append((rate, 0, (self._force(stroke, rate).force - force) / scale))
        return rate
