"""The report: says what the result says, needs nothing else, opens in a browser."""

import dataclasses
import html
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as ElementTree
from base64 import b64decode

import numpy as np
import pytest
from matplotlib.image import imread

import damperopt
from damperopt.output import report_of, words, write_report
from damperopt.output.gallery import write_design
from damperopt.study.scope import covers

COMMAND = [sys.executable, "-c", "from damperopt.cli import main; main()", "report"]


@pytest.fixture(scope="module")
def solved(request):
    study = damperopt.load(request.config.rootpath / "configs" / "thesis_gear.yaml").replace(solver__starts=2)
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
    assert f"{result.mass.total:.3f} kg: arreaza layout in AISI 4340" in text
    assert "arreaza: One torque link; a bending arm in the plane of the strut, and a damper of length b across it" in text
    assert "Proved in rational arithmetic, without rounding: margin 0.1 1/s, every real speed from 5 to 100 m/s, 150 kN" in text
    for part, mass in result.mass.parts.items():
        assert f"{mass:.2f} kg {part}" in text
    assert f"length of a torque link L {1e3 * result.design['L']:.5g} mm" in text
    assert f"angle of a torque link to the strut axis gamma {np.degrees(result.design['gamma']):.5g} deg" in text
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


def test_says_first_what_the_proof_covers_and_what_not(solved, page):
    text = plain(page.read_text())
    top = text[: text.index("What was asked")]
    assert "joints in contact (no freeplay, no end stop reached), no friction, rigid: torque links" in top
    for sentence in solved[1].not_checked:
        assert sentence in top
    assert "This page repeats result.json as it was found" in text


def test_says_what_of_the_study_the_proof_leaves_out(solved):
    study, _ = solved
    assert len(covers(study)) == 1
    loose = study.replace(
        damper__freeplay={"gap": 1e-3}, gear__friction={"torque": 50.0}, requirements__limit_event="simulated"
    )
    _, left_out, event = covers(loose)
    assert "freeplay and friction, which the certificate does not cover: a limit cycle can remain" in left_out
    assert "no load of ground handling remains" in event
    soft = study.replace(damper__link_stiffness=1e7, damper__series_stiffness=1e8)
    assert "as stiff as the study says: torque links, oil column and rod" in covers(soft)[0]
    assert "elastic by their sections: torque links, support" in covers(study.replace(damper__compliance="sized"))[0]


def test_says_loads_sizes_damping_and_the_next_critical_speed(solved, page):
    _, result = solved
    text = plain(page.read_text())
    assert f"damper force {result.limit_event['damper_force'] / 1e3:.5g} kN" in text
    speed = result.limit_event["damper_force"] / result.design["c_lambda"]
    assert f"damper speed {speed:.5g} m/s" in text
    assert "lower torque link, root outer diameter" in text
    assert "damper cylinder bore" in text
    assert "damper cylinder peak pressure 20.7 MPa" in text
    assert "lateral 0.225 16.2" in text  # the lateral mode of Table 0.1, which no yaw damper reaches
    assert "No critical speed from there to 300 m/s" in text


def test_bold_is_what_binds(page):
    rows = re.findall(r"<tr( class=\"strong\")?><th scope=\"row\">([^<]*)", page.read_text())
    bold = {name for strong, name in rows if strong}
    assert {"arm stress", "tyre clearance"} <= bold
    assert not {"arm fatigue", "damping of the damper"} & bold
    assert 'th[scope="row"] { font-weight: 400; }' in page.read_text()


@pytest.fixture(scope="module")
def browser():
    found = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
    if found is None:
        pytest.skip("no Chromium: the page was not opened (Debian: apt-get install chromium)")

    def run(*options):
        quiet = ("--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update")
        with tempfile.TemporaryDirectory() as own:
            command = [found, "--headless", "--no-sandbox", "--disable-gpu", *quiet, "--disable-sync", f"--user-data-dir={own}"]
            subprocess.run([*command, *options], check=True, capture_output=True, timeout=120)

    return run


@pytest.mark.slow
def test_opens_in_a_browser(page, browser, tmp_path):
    picture = tmp_path / "page.png"
    browser(f"--screenshot={picture}", "--window-size=900,1200", page.as_uri())
    pixels = imread(picture)[..., :3]
    assert pixels.shape[1] == 900
    assert 0.01 < (pixels.min(axis=2) < 0.5).mean() < 0.5  # there is writing, and it is not a black page


@pytest.mark.slow
def test_on_paper_the_study_is_unfolded(page, browser, tmp_path):
    """What is folded on the screen has a copy for paper: the printed page is longer by the study than without it."""
    without = tmp_path / "without.html"
    without.write_text(re.sub(r'<div class="paper".*?</div>', "", page.read_text(), flags=re.DOTALL))
    pages = []
    for file in (page, without):
        browser(f"--print-to-pdf={tmp_path / 'page.pdf'}", file.as_uri())
        pages.append((tmp_path / "page.pdf").read_bytes().count(b"/Type /Page\n"))
    assert pages[0] > pages[1] > 2


@pytest.mark.slow
def test_figures_that_are_not_there_are_drawn(page, tmp_path):
    there = ["linkage.svg", "modes.svg", "region.svg", "decay.svg", "tornado.svg"]
    for name in ("result.json", *there):
        shutil.copy(page.with_name(name), tmp_path)
    done = subprocess.run([*COMMAND, tmp_path], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "report.html").read_text().count("data:image/svg+xml") == 7
    assert {f.name for f in tmp_path.iterdir()} == {"report.html", "result.json", *there}


@pytest.mark.slow
def test_no_design_says_what_is_missing(main_gear, tmp_path):
    study = main_gear.replace(damper__topology="boeing", solver__starts=1, requirements__stability_margin=2.0)
    result = damperopt.optimise(study)
    assert result.status == "infeasible"
    (tmp_path / "result.json").write_text(result.to_json())
    text = plain(write_report(tmp_path).read_text())
    assert "No design:" in text
    assert "The smallest set of limits that would have to give way" in text
    assert result.infeasibility.shortfalls[0].name.replace("_", " ") in text


def test_ranking_has_a_row_for_each_combination(solved, page):
    _, result = solved
    other = result.model_copy(update={"material": "another steel"})
    text = plain(report_of([result, other], page.parent))
    assert "Ranking at equal margins" in text
    assert "2 arreaza another steel" in text


def test_folder_without_a_result_is_refused(tmp_path):
    done = subprocess.run([*COMMAND, tmp_path], capture_output=True, text=True)
    assert done.returncode == 2
    assert "holds no result.json" in done.stderr


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
    study, result = solved
    assert "at 100 to 150 kN" in words.asked(study.replace(envelope__vertical_load={"min": 100e3, "max": 150e3}))[1]
    assert "at 100, 150 kN" in words.asked(study.replace(envelope__vertical_load=[100e3, 150e3]))[1]
    missed = result.model_copy(update={"certificate": dataclasses.replace(result.certificate, proved=False, reason="missed")})
    assert words.certificate(missed).startswith("NOT proved")
    assert "How:" not in words.certificate(missed)
