"""A study through the commands, in this process: checked, analysed, charted, simulated, optimised, reported."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import standard
import yaml

import damperopt
from damperopt import Study
from damperopt.commands.studies import validate
from damperopt.output import write_report
from damperopt.output.gallery import Answer, figures_of, write_design
from damperopt.output.tables import write_chart, write_modes
from damperopt.results import DesignResult


def goes_through_the_commands(study: Study, folder: Path) -> None:
    """Valid, analysed with a certificate, charted, and simulated in both ways with all that it declares in the table."""
    file = folder / "study.yaml"
    file.write_text(yaml.safe_dump(study.model_dump(mode="json", exclude_none=True)), encoding="utf-8")
    validate([file])
    low, high, load = study.envelope.speed.min, study.envelope.speed.max, study.envelope.loads[0]
    gear = damperopt.linear_gear(study)
    modes = damperopt.track_modes(gear, np.linspace(low, high, 12), load)
    assert len(modes.names) >= len(gear.principal)  # a conjugate pair has one name
    write_modes(folder / "modes.csv", [modes])
    worst = damperopt.worst_points(gear, study.envelope)[0]
    speeds = np.linspace(low, high, 200)
    assert worst.abscissa >= gear.abscissa(speeds, load).max() - 1e-9 * abs(worst.abscissa)
    certificate = damperopt.certify(study, study.start, margin=0.0)
    assert certificate.reason
    assert certificate.proved == (worst.abscissa < 0), certificate.reason
    first = next(iter(study.start.items()), None)
    x = None if first is None else (first[0], 0.1 * first[1], 10 * first[1])
    fixed = {} if x is None else {"speed": high}
    record = damperopt.chart(study, x or ("speed", low, high), ("vertical_load", load / 2, load), **fixed)
    assert record.families
    write_chart(folder / "chart.csv", record)
    question = {"speed": high / 2, "disturbance": {"release": {"yaw_angle": 1e-3}}, "duration": 0.03}
    smooth = damperopt.simulate(study, **question, engine="cvodes")
    exact = damperopt.simulate_exactly(study, **question)
    assert smooth.status == exact.status == "completed", (smooth.message, exact.message)
    assert set(smooth.states) == set(exact.states)
    assert set(smooth.outputs) == set(exact.outputs)
    for motion in (smooth, exact):
        standard.every_quantity_is_shown(study, motion, folder / "motion.csv")


@cache
def _optimum(study: str) -> DesignResult:
    """Of a study as JSON: what asks for the optimum of one study shares it."""
    return damperopt.optimise(Study.model_validate_json(study))


def is_optimised(study: Study, folder: Path) -> DesignResult | None:
    """A design or a reason why there is none; with a design, its proof and its files."""
    if not study.variables:
        with pytest.raises(damperopt.ConfigError):
            damperopt.optimise(study)
        return None
    result = _optimum(study.model_dump_json(exclude_none=True))
    assert result.status in ("solved", "infeasible"), result.message
    if result.status == "solved":
        assert result.certificate.proved
        assert result.mass.total == pytest.approx(sum(result.mass.parts.values()))
    write_design(folder, study, result, figures=False)
    assert damperopt.load_result(folder / "result.json") == result
    return result


def is_reported(study: Study, folder: Path) -> None:
    """Every figure can be drawn, and the page shows them; it would leave out one that fails."""
    result = is_optimised(study, folder)
    if result is None:
        return
    for figure in figures_of(result):
        drawn = figure.drawn(Answer.of(study, result))
        drawn.set_dpi(30)
        drawn.canvas.draw()  # symbols are typeset here; writing all files in full takes longer than all else
        plt.close(drawn)
        (folder / f"{figure.name}.svg").write_text('<svg xmlns="http://www.w3.org/2000/svg"/>', encoding="utf-8")
    page = write_report(folder).read_text(encoding="utf-8")
    assert page.count("<svg") + page.count("data:image/svg") >= len(figures_of(result))
