"""Whether the oil of a damper cavitates at a force: the pressure on its suction side, from that with which it is charged.

In a closed damper both chambers are charged alike and, about the middle of the stroke, as stiff as each other: a force F on the
area A raises one by F/(2 A) and lowers the other by as much. Below the vapour pressure of the oil that chamber boils, and the
damping that the equations have is not there.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..dampers.oil import VAPOUR_PRESSURE
from ..linkages.elastic import elastic_linkage
from ..strength.limit_event import limit_event
from .study import Study

__all__ = ["cavitation", "suction_pressure"]


def suction_pressure(charge: float, force: float, area: float) -> float:
    """charge - F/(2 A) [Pa], absolute.

    Parameters
    ----------
    charge : float
        Of both chambers at rest [Pa], absolute.
    force : float
        In the damper [N], or its torque [N m].
    area : float
        Of the piston [m^2], or the displacement of the vanes [m^3/rad].

    Examples
    --------
    >>> round(suction_pressure(1.0e6, 2.4e3, 6e-4))
    -1000000
    """
    return charge - force / (2 * area)


def cavitation(study: Study, design: Mapping[str, float], force: float | None = None) -> str:
    """What is to be said of cavitation, in words; empty where the oil stays liquid, or the charge is not known.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].
    force : float or None
        Largest in the damper [N], or torque [N m], such as a simulation shows; None: that of the limit event.
    """
    damper = study.damper
    charge = getattr(damper, "charge_pressure", None)
    if charge is None:
        return ""
    event: Any = None
    if study.requirements is not None:
        link = elastic_linkage(study, design)
        event = limit_event(study, link, design, max(study.envelope.loads))
    if force is None and event is None:
        return ""
    force = abs(float(event.damper_force if force is None else force))
    area = damper.swept(design)
    if area is None and event is None:
        return ""
    area = float(event.damper_force) / study.mass.working_pressure if area is None else float(area)
    left = suction_pressure(charge, force, area)
    boils = VAPOUR_PRESSURE if damper.vapour_pressure is None else damper.vapour_pressure
    if left >= boils:
        return ""
    rotary, needed = damper.ROTARY, boils + force / (2 * area)
    what = f"{force / 1e3:.3g} {'kN m' if rotary else 'kN'}"
    return (
        f"damper.charge_pressure: at {what} the suction side would be at {left / 1e6:.3g} MPa, below the vapour pressure: the "
        f"oil cavitates, and the damping is not that of the equations; enough for this: {needed / 1e6:.3g} MPa"
    )
