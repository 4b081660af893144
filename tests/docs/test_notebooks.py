"""The notebooks run from start to end in a fresh kernel, and their conclusions hold: each ends with assertions."""

from pathlib import Path

import jupytext
import pytest
from nbclient import NotebookClient

ROOT = Path(__file__).parents[2]
PICTURES = {"01": 3, "02": 1, "03": 2, "04": 2, "05": 2}
NOTEBOOKS = sorted((ROOT / "docs" / "notebooks").glob("*.md"))


@pytest.mark.slow
@pytest.mark.filterwarnings(
    "ignore::DeprecationWarning", "ignore::ResourceWarning", "ignore::pytest.PytestUnraisableExceptionWarning"
)
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebook_runs(path, monkeypatch):
    """In the project's folder, as a reader would start it; warnings are the kernel's and its libraries'."""
    monkeypatch.delenv("MPLBACKEND")  # a kernel has one of its own
    notebook = jupytext.read(path)
    NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(ROOT)}}).execute()
    pictures = [out for cell in notebook.cells for out in cell.get("outputs", ()) if "image/png" in out.get("data", {})]
    assert len(pictures) == PICTURES[path.stem[:2]]


def test_there_are_five_and_each_ends_with_numbers():
    assert len(NOTEBOOKS) == 5
    for path in NOTEBOOKS:
        last = jupytext.read(path).cells[-1].source
        assert "print(" in last
        assert "assert " in last
