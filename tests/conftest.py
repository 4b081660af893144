"""Fixtures that every test may use."""

import os
from pathlib import Path

import pytest

import damperopt
import damperopt.answers.bound

os.environ.setdefault("MPLBACKEND", "Agg")  # no windows; processes that tests start inherit it

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def configs() -> Path:
    """Folder of the shipped studies."""
    return ROOT / "configs"


@pytest.fixture(scope="session")
def main_gear_with_decay(configs) -> damperopt.Study:
    """The thesis' main gear, Table 0.1, as it is shipped."""
    return damperopt.load(configs / "thesis_gear.yaml")


@pytest.fixture(scope="session")
def main_gear(main_gear_with_decay) -> damperopt.Study:
    """The same with the linear requirements only: stability margin, strength and geometry."""
    return main_gear_with_decay.replace(requirements__decay=None)


@pytest.fixture(autouse=True)
def _no_bound_is_searched(request, monkeypatch):
    """Tests of everything else optimise often: only those marked `bound` search for the lower bound too."""
    if request.node.get_closest_marker("bound") is None:
        words = damperopt.answers.bound.MassBound(why="left out by the tests")
        monkeypatch.setattr("damperopt.design.mass_bound", lambda study, result: words)
