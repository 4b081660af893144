"""Notebooks run from start to end in a fresh kernel and their conclusions hold; the documentation builds without a warning."""

import os
import re
import subprocess
import sys
from pathlib import Path

import jupytext
import pytest
from nbclient import NotebookClient

import damperopt

ROOT = Path(__file__).parents[2]
PICTURES = {"01": 3, "02": 1, "03": 2, "04": 2, "05": 2, "06": 2, "07": 0}
NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.md"))


@pytest.mark.slow
@pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path, monkeypatch):
    """In its own folder, as a reader would start it; warnings are the kernel's and its libraries'."""
    monkeypatch.delenv("MPLBACKEND")  # a kernel has one of its own
    notebook = jupytext.read(path)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(path.parent)}}).execute()
    pictures = [out for cell in notebook.cells for out in cell.get("outputs", ()) if "image/png" in out.get("data", {})]
    assert len(pictures) == PICTURES[path.stem[:2]]


def test_there_are_seven_and_each_ends_with_numbers():
    assert len(NOTEBOOKS) == 7
    for path in NOTEBOOKS:
        last = jupytext.read(path).cells[-1].source
        assert "print(" in last
        assert "assert " in last


@pytest.mark.slow
@pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
def test_validation_page_agrees_with_what_is_published(monkeypatch):
    """Its own last cell holds the differences to half a per cent."""
    monkeypatch.delenv("MPLBACKEND")
    page = ROOT / "docs" / "validation.md"
    notebook = jupytext.read(page)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(page.parent)}}).execute()
    assert "14 numbers" in notebook.cells[-2].outputs[0]["text"]


@pytest.mark.slow
def test_documentation_builds_without_a_warning(tmp_path):
    """The text and the interface; notebooks run in the tests above."""
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-b", "html", ROOT / "docs", tmp_path / "html"]
    doctrees = ["-d", tmp_path / "doctrees"]
    environment = os.environ | {"DOCS_EXECUTE": "off"}
    done = subprocess.run([*command, *doctrees], capture_output=True, text=True, env=environment)
    assert done.returncode == 0, done.stderr
    text = (tmp_path / "html" / "api.html").read_text()
    missing = [name for name in damperopt.__all__ if f"damperopt.{name}" not in text and f".{name}" not in text]
    assert not missing


def test_links_between_pages_and_to_headings_exist():
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md"), *NOTEBOOKS]
    for page in pages:
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text()):
            if "://" not in target:
                assert (page.parent / target).exists(), f"{page}: {target}"
