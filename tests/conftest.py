"""Fixtures that every test may use."""

from pathlib import Path

import pytest

import damperopt

ROOT = Path(__file__).parents[1]


@pytest.fixture(scope="session")
def configs() -> Path:
    """Folder of the shipped studies."""
    return ROOT / "configs"


@pytest.fixture(scope="session")
def main_gear(configs) -> damperopt.Study:
    """The thesis' main gear, Table 0.1."""
    return damperopt.load(configs / "main_gear.yaml")
