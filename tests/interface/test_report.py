"""The report: says what the result says, needs nothing else, opens in a browser."""

import dataclasses
import html
import re
import shutil
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from base64 import b64decode

import numpy as np
import pytest

import damperopt
from damperopt.linkages.assembly import layouts
from damperopt.output import report_of, write_report
from damperopt.output.gallery import write_design

COMMAND = [sys.executable, "-c", "from damperopt.cli import main; main()", "report"]


@pytest.fixture(scope="module")
def solved(request):
    study = damperopt.load(request.config.rootpath / "configs" / "main_gear.yaml").replace(solver__starts=4)
    return study, damperopt.optimise(study)


@pytest.fixture(scope="module")
def page(solved, tmp_path_factory):
    folder = tmp_path_factory.mktemp("report")
    write_design(folder, *solved, figures=True)
    return write_report(folder)


def plain(text):
    return " ".join(html.unescape(re.sub(r"<(style|script).*?</\1>|<[^>]*>", " ", text, flags=re.DOTALL)).split())


def test_says_what_the_result_says(solved, page):
    _, result = solved
    text = plain(page.read_text())
    assert f"{result.mass.total:.3f} kg: new design in AISI 4340" in text
    assert "Proved in rational arithmetic, without rounding: margin 0.1 1/s, every real speed from 5 to 100 m/s, 150 kN" in text
    for part, mass in result.mass.parts.items():
        assert f"{mass:.2f} kg {part}" in text
    assert f"length of the torque links L {1e3 * result.design['L']:.5g} mm" in text
    assert f"angle of the links from the strut axis gamma {np.degrees(result.design['gamma']):.5g} deg" in text
    for constraint in result.constraints:
        assert constraint.name.replace("_", " ") in text
    for sentence in result.not_checked:
        assert sentence in text
    assert result.provenance.config_sha256 in text


def test_needs_no_other_file_and_no_network(page):
    text = page.read_text()
    assert not re.findall(r"(?:https?:)?//[a-z]", re.sub(r"base64,[^\"]*", "", text))
    sources = re.findall(r'src="([^"]*)"', text)
    assert len(sources) == 7
    for source in sources:
        kind, data = source.split(",", 1)
        assert kind == "data:image/svg+xml;base64"
        assert ElementTree.fromstring(b64decode(data)).tag.endswith("svg")
    assert "<script" not in text


def test_every_figure_has_words_and_every_table_can_be_reached_by_keyboard(page):
    text = page.read_text()
    assert all(len(alt) > 20 for alt in re.findall(r'<img [^>]*alt="([^"]*)"', text))
    assert text.count("<img ") == text.count(" alt=")
    assert text.count("<table") == text.count('class="scroll" tabindex="0" role="region" aria-label=')
    assert "prefers-color-scheme: dark" in text
    assert "@media print" in text


def test_opens_in_a_browser(page, tmp_path):
    browser = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if browser is None:
        pytest.skip("no Chromium on this machine: the page was not opened in a browser")
    picture = tmp_path / "page.png"
    command = [browser, "--headless", "--no-sandbox", "--disable-gpu", f"--screenshot={picture}", "--window-size=900,1200"]
    subprocess.run([*command, page.as_uri()], check=True, capture_output=True, timeout=120)
    from matplotlib.image import imread

    pixels = imread(picture)[..., :3]
    assert pixels.shape[1] == 900
    assert 0.01 < (pixels.min(axis=2) < 0.5).mean() < 0.5  # there is writing, and it is not a black page


def test_figures_that_are_not_there_are_drawn(solved, tmp_path):
    _, result = solved
    (tmp_path / "result.json").write_text(result.to_json())
    done = subprocess.run([*COMMAND, tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "report.html").read_text().count("data:image/svg+xml") == 7
    assert sorted(f.name for f in tmp_path.iterdir()) == ["report.html", "result.json"]


def test_no_design_says_what_is_missing(main_gear, tmp_path):
    study = main_gear.replace(solver__starts=4, requirements__stability_margin=2.0)
    result = damperopt.optimise(study)
    assert result.status == "infeasible"
    (tmp_path / "result.json").write_text(result.to_json())
    text = plain(write_report(tmp_path).read_text())
    assert "No design:" in text
    assert "The smallest set of limits that would have to give way" in text
    assert result.infeasibility.shortfalls[0].name.replace("_", " ") in text


def test_ranking_has_a_row_for_each_combination(solved):
    _, result = solved
    other = result.model_copy(update={"material": "another steel"})
    text = plain(report_of([result, other]))
    assert "Ranking at equal margins" in text
    assert "2 arreaza another steel" in text


def test_folder_without_a_result_is_refused(tmp_path):
    done = subprocess.run([*COMMAND, tmp_path], capture_output=True, text=True)
    assert done.returncode == 2
    assert "holds no result.json" in done.stderr


DESIGN = {"L": 0.6, "gamma": np.deg2rad(31.0), "b": 0.2}


@pytest.mark.parametrize("topology", ["boeing", "utas", "arreaza"])
def test_parts_of_the_drawing_are_those_of_the_theory(topology):
    """Links of length L, arm of UTAS hypot(L, b), damper of the new design b and at right angles to the link."""
    parts = {
        part.name: np.subtract(part.end, part.start)
        for part in layouts()[topology].model_construct(topology=topology).members(DESIGN)
    }
    assert np.linalg.norm(parts["lower torque link"]) == pytest.approx(0.6)
    if topology == "utas":
        assert np.linalg.norm(parts["bending arm"]) == pytest.approx(np.hypot(0.6, 0.2))
        assert np.linalg.norm(parts["damper"]) == pytest.approx(np.hypot(0.6, 0.2))
    if topology == "arreaza":
        assert np.linalg.norm(parts["bending arm"]) == pytest.approx(0.6)
        assert np.linalg.norm(parts["damper"]) == pytest.approx(0.2)
        assert parts["damper"] @ parts["lower torque link"] == pytest.approx(0.0)


def test_studies_and_results_show_themselves_in_a_notebook(solved):
    study, result = solved
    assert f"<b>{result.mass.total:.3f} kg</b>" in result._repr_html_()
    assert "<th>c_lambda</th>" in result._repr_html_()
    assert "topology: arreaza" in study.replace(name="a <b> name")._repr_html_()
    assert "a &lt;b&gt; name" in study.replace(name="a <b> name")._repr_html_()


def test_progress_is_shown_when_asked_for(main_gear, capsys):
    damperopt.optimise(main_gear.replace(damper__topology="boeing", solver__starts=2), progress=True)
    shown = capsys.readouterr().err
    assert "boeing, AISI 4340" in shown
    assert "2/2" in shown


def test_a_range_of_loads_is_a_range_and_nothing_unproved_is_explained(solved):
    from damperopt.output import words

    study, result = solved
    assert "at 100 to 150 kN" in words.asked(study.replace(envelope__vertical_load={"min": 100e3, "max": 150e3}))[1]
    assert "at 100, 150 kN" in words.asked(study.replace(envelope__vertical_load=[100e3, 150e3]))[1]
    missed = result.model_copy(update={"certificate": dataclasses.replace(result.certificate, proved=False, reason="missed")})
    assert words.certificate(missed).startswith("NOT proved")
    assert "How:" not in words.certificate(missed)
