"""What a simplified model of the linkage leaves out, by number for the design at hand.

Geometries `published` and `planar` bend the arm over its horizontal reach, and a rigid chain takes no account of the links that
it has sized. The design is looked at once more in space, with parts as elastic as the sections that strength asks of them.
"""

from __future__ import annotations

from collections.abc import Mapping

from ..linkages.elastic import elastic_linkage
from ..stability.linear import LinearModel
from ..stability.worst import worst_points
from ..study.asked import asked_sizes
from ..study.study import Study
from .problem import DesignProblem

__all__ = ["left_out_by_number"]


def left_out_by_number(study: Study, design: Mapping[str, float]) -> tuple[str, ...]:
    """Sentences on geometry and compliance; none where the study has the linkage in space with elastic parts.

    Parameters
    ----------
    study : Study
    design : mapping of str to float
        Design variables by name [SI].

    Returns
    -------
    tuple of str
    """
    damper = study.damper
    if damper.ROTARY or not damper.elastic_parts():
        return ()
    rigid = [part for part in damper.elastic_parts() if not damper.is_sized(part) and part not in damper.given_compliance()]
    if damper.geometry == "spatial" and not rigid:
        return ()
    more = {"damper__compliance": _sized(rigid, damper), "requirements__limit_event": "torque"}
    full_study = study.replace(damper__geometry="spatial", **more)
    full = dict(design) | {k: v for k, v in asked_sizes(full_study, dict(design)).items() if k not in design}
    found = []
    if damper.geometry != "spatial":
        found.append(_in_space(study, full_study, design, full))
    if rigid:
        worst = worst_points(LinearModel(full_study).at(full), full_study.envelope)[0]
        found.append(
            f"the parts are taken as rigid ({', '.join(rigid)}); in space, elastic by the sections that strength asks of them, "
            f"the largest real part is {worst.abscissa:+.3g} 1/s at {worst.speed:.3g} m/s"
        )
    return tuple(found)


def _sized(rigid: list[str], damper: object) -> dict[str, object]:
    kept = {part: getattr(damper.compliance, part) for part in type(damper.compliance).model_fields}  # type: ignore[attr-defined]
    return kept | dict.fromkeys(rigid, "sized")


def _in_space(study: Study, full_study: Study, design: Mapping[str, float], full: Mapping[str, float]) -> str:
    """Stiffness about the yaw axis here and in space, and how much of its allowable stress an arm carries there."""
    here, there = elastic_linkage(study, design), elastic_linkage(full_study, full)
    stiff = [float(link.torsional_stiffness) for link in (here, there)]
    words = f"geometry {study.damper.geometry}: in space k_psi is {stiff[1]:.3g} instead of {stiff[0]:.3g} N m/rad"
    values = DesignProblem(full_study).values(full)
    carried = [stress / allowed for name, (stress, allowed) in values.items() if name in ("arm_limit", "arm_ultimate")]
    if carried:
        words += f", and the arm carries {max(carried):.3g} times its allowable stress"
    return words
