"""Rules of the house that a machine can hold us to."""

import importlib
import inspect
import pkgutil
import re
import runpy
import subprocess
import sys
from pathlib import Path

import pytest

import damperopt

ROOT = Path(__file__).parents[2]
MODULES = [name.partition(".")[2] for _, name, _ in pkgutil.walk_packages(damperopt.__path__, "damperopt.")]


def public_objects():
    for module_name in MODULES:
        module = importlib.import_module(f"damperopt.{module_name}")
        for name in getattr(module, "__all__", ()):
            yield module_name, name, getattr(module, name)


def test_import_contracts_hold():
    done = subprocess.run([Path(sys.executable).with_name("lint-imports")], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout


@pytest.mark.parametrize("module", MODULES)
def test_every_module_says_what_it_is_for_and_lists_its_names(module):
    loaded = importlib.import_module(f"damperopt.{module}")
    assert loaded.__doc__
    if module == "__main__":
        return
    assert loaded.__all__ or hasattr(loaded, "__path__")  # a room lists what is more than its modules
    assert all(hasattr(loaded, name) for name in loaded.__all__)


def test_every_public_name_is_documented():
    missing = [f"{m}.{n}" for m, n, thing in public_objects() if callable(thing) and not inspect.getdoc(thing)]
    assert not missing


def test_docstrings_of_public_functions_name_every_parameter():
    """Functions of the package's own list, and those with three parameters or more, have a Parameters section."""
    problems = []
    for module, name, thing in public_objects():
        if not inspect.isfunction(thing) or module.split(".")[0] in ("cli", "commands"):
            continue
        doc = inspect.getdoc(thing)
        parameters = [p for p in inspect.signature(thing).parameters if p not in ("self", "progress")]
        if (name in damperopt.__all__ or len(parameters) > 2) and parameters and "Parameters\n" not in doc and "\n" in doc:
            problems.append(f"{module}.{name}: no Parameters section")
        if "Parameters\n" in doc:
            problems += [f"{module}.{name}: {p}" for p in parameters if not re.search(rf"\b{p}\b", doc)]
    assert not problems


def test_no_module_is_longer_than_400_lines():
    lengths = {str(f): len(f.read_text().splitlines()) for f in (ROOT / "damperopt").rglob("*.py")}
    assert max(lengths.values()) <= 400, lengths


def test_the_public_list_is_sorted_and_complete():
    assert damperopt.__all__ == sorted(damperopt.__all__)
    for name in damperopt.__all__:
        assert getattr(damperopt, name) is not None


def test_no_path_of_a_machine_in_the_tree():
    files = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.split()
    pattern = re.compile(r"/(?:home|root|work|tmp|Users)/\w")
    for file in files:
        if Path(file).suffix in (".py", ".md", ".yaml", ".toml", ".yml", "") and (ROOT / file).is_file():
            assert not pattern.search((ROOT / file).read_text(encoding="utf-8")), file


def test_numbers_of_readme_and_changelog_are_those_of_the_frozen_optima():
    """The optima themselves are tested in tests/optima."""
    optima = ROOT / "tests" / "optima"
    frozen = runpy.run_path(str(optima / "test_main_gear.py"))["FROZEN"]
    with_decay = runpy.run_path(str(optima / "test_main_gear_decay.py"))["FROZEN_WITH_DECAY"]
    changelog, readme = (ROOT / "CHANGELOG.md").read_text(), (ROOT / "README.md").read_text()
    for layout, (mass, _, _) in frozen.items():
        assert f"| {layout} | {mass:.3f} |" in changelog
        heavier = with_decay[layout][0]
        assert f"| {layout} | {heavier:.3f} | {100 * (heavier / mass - 1):.1f} % |" in changelog
    whole = runpy.run_path(str(optima / "test_whole_gear.py"))["FROZEN"]
    for layout, (mass, _, _) in whole.items():
        assert f"| {layout} | {with_decay[layout][0]:.3f} kg | {mass:.3f} kg |" in changelog
    mass, design, _ = whole["arreaza"]
    assert f"{mass:.3f} kg = " in readme
    assert f"{design['c_lambda']:.0f}  N s/m" in readme
    assert f"{design['L']:.5f}" in readme


@pytest.mark.slow
def test_python_of_the_readme_runs():
    code = re.search(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL).group(1)
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert "proved=True" in done.stdout
