"""Figures: names of users stay names, one figure that fails costs nothing else, what is not drawn has no legend."""

import dataclasses
import logging
import re
import subprocess
import sys

import matplotlib.pyplot as plt
import numpy as np
import pytest

import damperopt
from damperopt import figures
from damperopt.charts.maps import FilledMap
from damperopt.figures.chart import chart as draw_chart
from damperopt.figures.linkage import linkage
from damperopt.figures.style import quantity_words
from damperopt.motion.trajectory import Motion, Trajectory
from damperopt.results import DesignResult, MassResult, Sensitivity
from damperopt.stability.modes import ModeTable

HOSTILE = (
    r"plain $\frac{$ x",
    r"cost $x_$ and $y$",
    r"\$ \\$ $$ \alpha^",
    "_hidden",
    "[/red] [bold]x",
    "\x1b[31mred\x07",
    "two\nlines\tand tab",
    "lone \ud800 half",
    "x" * 4000,
)


@pytest.fixture(autouse=True)
def _closed():
    yield
    plt.close("all")


def result(name):
    return DesignResult(
        status="failed",
        message=name,
        study=name,
        topology=name,
        geometry=name,
        material=name,
        stability_margin=0.1,
        mass=MassResult(total=3.0, parts={name: 1.0, "links": 2.0}),
        sensitivities=(Sensitivity(input=name, value=1.0, unit="m", derivative=1.0, elasticity=0.5),),
    )


def table(name):
    roots = np.array([[-1 + 9j, -1 - 9j, -50], [-2 + 9j, -2 - 9j, -60]])
    return ModeTable(np.array([5.0, 10.0]), 1e4, (name, name, "string"), roots)


def motion(name):
    t = np.linspace(0, 1, 50)
    states = {"yaw_angle": np.cos(t), "lateral_displacement": np.sin(t), "string_deflection": t}
    record = Trajectory(5.0, 1e4, t, states, {}, "stopped", name, name)
    return figures.trajectory(record, Motion("decaying", 1.0, 0.5, 0.1, 5.0, 0.0, {}))


def test_names_of_users_are_no_formulas():
    figure, axis = plt.subplots()
    for name in HOSTILE:
        axis.plot([0, 1], [0, 1], label=figures.plain(name))
        axis.set_title(figures.plain(name))
        figure.draw_without_rendering()
    shown = [text.get_text() for text in axis.legend().get_texts()]
    assert len(shown) == len(HOSTILE)  # a label that starts with _ would be left out
    assert all(text.replace("\\$", "").isprintable() and len(text) < 100 for text in shown)


def test_every_figure_takes_names_as_names(tmp_path):
    name = HOSTILE[0]
    drawings = {
        "mass": lambda: figures.mass_by_part(result(name)),
        "tornado": lambda: figures.tornado(result(name)),
        "modes": lambda: figures.modes_over_speed(table(name), 0.1, name),
        "both": lambda: figures.modes_before_after(table(name), table(name), 0.1),
        "motion": lambda: motion(name),
    }
    assert figures.save_each(drawings, tmp_path) == []
    assert len(list(tmp_path.iterdir())) == 2 * len(drawings)


def test_figure_that_fails_is_a_warning_and_costs_nothing_else(tmp_path, caplog):
    def fails():
        _, axis = plt.subplots()
        axis.set_title("$\\frac{$")
        return axis.figure

    with caplog.at_level(logging.WARNING, logger="damperopt"):
        failed = figures.save_each({"bad": fails, "good": lambda: figures.mass_by_part(result("a"))}, tmp_path)
    assert failed == ["bad"]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["good.png", "good.svg"]
    assert "the figure 'bad' was not drawn" in caplog.text


def test_design_keeps_its_data_where_no_figure_can_be_drawn(main_gear, tmp_path, monkeypatch, caplog):
    from damperopt.output import gallery, write_report

    study = main_gear.replace(damper__topology="boeing", solver__starts=1, requirements__decay=None, name=r"plain $\frac{$ x")
    found = damperopt.optimise(study)

    def broken(*_):
        raise RuntimeError("no font")

    few = [figure for figure in gallery.figures_of(found) if figure.name in ("linkage", "mass")]
    monkeypatch.setattr(gallery, "_FIGURES", tuple(few))
    monkeypatch.setattr("damperopt.figures.design.mass_by_part", broken)
    gallery.write_design(tmp_path, study, found, figures=True)
    assert damperopt.load_result(tmp_path) == found
    assert not (tmp_path / "mass.svg").exists()
    assert (tmp_path / "linkage.svg").exists()
    assert (tmp_path / "modes.csv").exists()
    assert "This figure could not be drawn." in write_report(tmp_path).read_text()
    assert "no font" in caplog.text


@pytest.mark.parametrize(
    ("key", "words"),
    [
        ("gear.lateral.stiffness", "Lateral stiffness"),
        ("damper.series_stiffness", "Series stiffness"),
        ("material.density", "Material density"),
        ("vertical_load", "Vertical load"),
    ],
)
def test_labels_say_what_a_quantity_belongs_to(key, words):
    assert quantity_words(key) == words


@pytest.fixture(scope="module")
def charts(main_gear):
    """Of L in a family, with a design that is none of its members; and without any boundary."""
    study = main_gear.replace(damper__topology="boeing")
    axes = ("c_lambda", 0.0, 2e4), ("k_lambda", 0.0, 1e8)
    design = study.start
    family = damperopt.chart(study, *axes, vary=("L", [0.3, 0.9]), design=design, cells=8, tolerance=1e-3)
    calm = ("c_lambda", 5e4, 6e4), ("k_lambda", 5e7, 6e7)
    empty = damperopt.chart(study, *calm, vary=("speed", [5.0, 6.0]), design=design, cells=8, tolerance=1e-3)
    return study, family, empty


def texts(figure):
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_star_is_labelled_with_the_design_and_not_with_a_member_of_the_family(charts):
    study, family, _ = charts
    own = damperopt.linear_gear(study, study.start).abscissa([study.envelope.speed.max], [150e3])[0]
    assert family.abscissa == pytest.approx(own, rel=1e-9)
    assert all(abs(member.abscissa - own) > 1e-3 for member in family.families)
    assert f"design, abscissa {own:.3g} 1/s" in texts(draw_chart(family))


def test_legend_has_a_line_only_for_what_is_drawn(charts):
    _, _, empty = charts
    assert not any(family.curves for family in empty.families)
    figure = draw_chart(empty, neutral=dataclasses.replace(empty, margin=0.0))
    assert "no margin" not in texts(figure)
    assert not any("divergence" in text for text in texts(figure))
    assert not any(text.startswith("design") for text in texts(figure))  # it lies outside the plane
    lines = [handle for handle in figure.legends[0].get_lines() if handle.get_linestyle() not in ("None", "none", "")]
    assert lines == []


def test_map_is_titled_with_what_fills_it(charts):
    _, family, _ = charts
    grid = np.linspace(0, 1e4, 4)
    damping = FilledMap("damping", grid, 1e4 * grid, np.outer(grid, grid))
    single = dataclasses.replace(family, varied=None, families=family.families[:1])
    figure = draw_chart(single, damping)
    assert figure.axes[0].get_title().startswith("Least damping ratio and stability boundary, 100 m/s, 150 kN")


def test_no_axis_has_an_offset(charts):
    figure = draw_chart(charts[1])
    figure.draw_without_rendering()
    axis = figure.axes[0]
    assert axis.xaxis.get_offset_text().get_text() == axis.yaxis.get_offset_text().get_text() == ""
    assert axis.get_xlim() == (0.0, 2e4)
    assert axis.get_ylim() == (0.0, 1e5)  # kN/m
    assert axis.get_ylabel().endswith("[kN/m]")


def test_matplotlib_comes_with_the_first_figure_only():
    late = "import sys, damperopt.figures as f; assert 'matplotlib' not in sys.modules; f.save; sys.modules['matplotlib']"
    subprocess.run([sys.executable, "-c", late], check=True)


def test_every_public_figure_is_there():
    assert all(callable(getattr(figures, name)) for name in figures.__all__)
    assert callable(linkage)


def test_written_figures_are_closed_and_both_files_have_one_layout(tmp_path):
    with figures.styled():
        figure, axis = plt.subplots(figsize=(4, 3))
        axis.set(xlabel="x", ylabel="a label\nof two lines", title="title")
        handle = plt.Line2D([], [])
        figure.legend([handle], ["below the axes"], loc="outside lower center")
    paths = figures.save(figure, tmp_path, "figure")
    assert plt.get_fignums() == []
    left, bottom, *_ = axis.get_position().bounds  # room was made for labels and legend
    assert left > 0.12
    assert bottom > 0.2
    assert plt.imread(paths[0]).shape[:2] == (450, 600)
    patch = re.search(r'id="patch_2">\s*<path d="M ([\d.]+) ([\d.]+)', paths[1].read_text())
    assert [float(number) for number in patch.groups()] == pytest.approx([288 * left, 216 * (1 - bottom)], abs=1e-3)
