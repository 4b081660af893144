"""A component of another distribution, with the metadata that an installation leaves, goes through the commands."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TYRE = (
    "tyre: {law: saturating, slope: 8 1/rad, rated_load: 200 kN, friction: 0.7, half_contact_length: 0.1,"
    " relaxation_length: 0.25}\n"
)


@pytest.fixture
def installed(tmp_path):
    """The example of docs/plugins.md as pip would leave it; a function that runs a command beside it."""
    page = (ROOT / "docs" / "plugins.md").read_text()
    place = tmp_path / "site"
    (place / "our_tyres").mkdir(parents=True)
    (place / "our_tyres" / "__init__.py").write_text("")
    code = re.search(r"```python\n(.*?)```", page, re.DOTALL).group(1)
    (place / "our_tyres" / "saturating.py").write_text(code)
    metadata = place / "our_tyres-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: our-tyres\nVersion: 1.0\n")
    group, point = re.search(r'entry-points\."(.*?)"\]\nsaturating = "(.*?)"', page).groups()
    (metadata / "entry_points.txt").write_text(f"[{group}]\nsaturating = {point}\n")
    minimal = (ROOT / "configs" / "minimal.yaml").read_text()
    (tmp_path / "study.yaml").write_text(re.sub(r"tyre:\n(?:  .*\n)+", TYRE, minimal) + "solver: {starts: 1}\n")

    def run(*arguments):
        path = os.pathsep.join([str(place), *filter(None, [os.environ.get("PYTHONPATH")])])
        command = [sys.executable, "-m", "damperopt", *arguments]
        return subprocess.run(command, cwd=tmp_path, env=os.environ | {"PYTHONPATH": path}, capture_output=True, text=True)

    run.place = place
    return run


@pytest.mark.slow
def test_the_example_of_the_page_goes_through_the_commands(installed):
    assert "saturating" in installed("components").stdout
    assert "valid" in installed("validate", "study.yaml").stdout
    found = installed("optimise", "study.yaml", "--no-figures")
    assert found.returncode == 0, found.stderr
    assert "proved" in found.stdout
    assert installed("simulate", "study.yaml", "--speed", "40", "--release", "yaw=0.2deg", "--duration", "0.1").returncode == 0


def test_a_broken_plug_in_is_one_message_that_names_its_distribution(installed):
    (installed.place / "our_tyres" / "saturating.py").write_text("1 / 0\n")
    done = installed("validate", "study.yaml")
    assert (done.returncode, "our-tyres" in done.stderr, "Traceback" in done.stderr) == (2, True, False), done.stderr
