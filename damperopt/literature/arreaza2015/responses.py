"""Responses of the thesis, Figs 4.5 to 4.20, from the values of their captions.

The figures are not at hand, and neither captions nor text give releases, durations and most damping values: those are a
choice. The thesis' Figs 4.6, 4.8 and 4.10 are those of Thota et al. (2009) at the conditions of Figs 4.5, 4.7 and 4.9.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from ...motion.simulate import Simulator
from ...motion.trajectory import Motion, Trajectory, motion_of
from ...stability.linear import LinearModel
from ...study.study import Study
from .charts import LOAD, STEEL, rigid

__all__ = ["RESPONSES", "Response", "ThesisResponse", "respond"]


@dataclass(frozen=True)
class ThesisResponse:
    """A response figure by the values of its caption [SI]."""

    number: str
    topology: str
    speed: float
    designs: tuple[Mapping[str, float], ...]
    load: float = LOAD
    release: Mapping[str, float] = field(default_factory=lambda: {"yaw_angle": 0.1})
    seconds: float = 20.0
    shown: float = 3.0


@dataclass(frozen=True)
class Response:
    """One motion of a figure.

    Attributes
    ----------
    design : mapping
        [SI]
    abscissa : float
        Spectral abscissa of the linear gear [1/s].
    trajectory : Trajectory
    motion : Motion
    """

    design: Mapping[str, float]
    abscissa: float
    trajectory: Trajectory
    motion: Motion


_SLENDER, _STIFF = 3.4e-6, 8.3e-6
_POINTS = ({"k_lambda": 3.8e6, "c_lambda": 1e3}, {"k_lambda": 1e7, "c_lambda": 5e3})
"""Two points of Fig. 3.5: own choice."""


def _dampings(I_arm: float, *c_lambda: float) -> tuple[dict[str, float], ...]:
    return tuple({"I_arm": I_arm, "c_lambda": c, "b": 0.15} for c in c_lambda)


_UTAS, _NEW = (1e4, 3e4, 1e5), (1e3, 3e3, 1e4)

RESPONSES = (
    ThesisResponse("4.5", "rotational", 40.0, ({},), seconds=12.0),
    ThesisResponse("4.7", "rotational", 175.0, ({},), 350e3, {"yaw_angle": 0.01, "bending_angle": 0.03}, 18.0),
    ThesisResponse("4.9", "rotational", 155.0, ({},), 350e3, {"yaw_angle": 0.05}, 60.0, 30.0),
    ThesisResponse("4.11", "boeing", 40.0, _POINTS),
    ThesisResponse("4.12", "boeing", 80.0, _POINTS),
    ThesisResponse("4.13", "boeing", 160.0, _POINTS),
    ThesisResponse("4.14", "utas", 40.0, _dampings(_SLENDER, *_UTAS)),
    ThesisResponse("4.15", "utas", 80.0, _dampings(_SLENDER, *_UTAS)),
    ThesisResponse("4.16", "utas", 80.0, _dampings(_STIFF, *_UTAS)),
    ThesisResponse("4.17", "arreaza", 40.0, _dampings(_SLENDER, *_NEW)),
    ThesisResponse("4.18", "arreaza", 80.0, _dampings(_SLENDER, *_NEW)),
    ThesisResponse("4.19", "arreaza", 160.0, _dampings(_SLENDER, *_NEW)),
    ThesisResponse("4.20", "arreaza", 80.0, _dampings(_STIFF, *_NEW)),
)
"""The lowest damping of each figure is unstable in every geometry."""

RAKE, WHEEL_RADIUS = 0.1571, 0.362
"""Of Thota et al. [rad], [m]; the thesis draws their Figs without rake, which cannot give what it sees (erratum 13)."""


def respond(figure: ThesisResponse, study: Study, geometry: str) -> list[Response]:
    """Motions of a figure.

    Parameters
    ----------
    figure : ThesisResponse
    study : Study
        The thesis' main gear.
    geometry : str
        ``published``, ``planar`` or ``spatial``; without a part where the strut's own stiffness and damping stand in.

    Returns
    -------
    list of Response
        One for each design of the figure.
    """
    if figure.topology == "rotational":
        strut = {"topology": "rotational", "torsional_stiffness": 3.8e5, "torsional_damping": 300.0}
        gear = study.replace(damper=strut, gear__rake_angle=RAKE, gear__wheel_radius=WHEEL_RADIUS)
    else:
        gear = study.replace(damper=rigid(figure.topology, geometry), material=STEEL)
    layout = {"L": 0.6, "gamma": float(np.deg2rad(31.0))}
    model, found = LinearModel(gear), []
    run = Simulator(gear, model=model)
    for given in figure.designs:
        design = {name: value for name, value in {**layout, **given}.items() if name in gear.start}
        release = {"release": dict(figure.release)}
        trajectory = run(figure.speed, figure.load, release, figure.seconds, design=design)
        abscissa = model.at(design).abscissa(figure.speed, figure.load)[0]
        found.append(Response(design, float(abscissa), trajectory, motion_of(trajectory)))
    return found
