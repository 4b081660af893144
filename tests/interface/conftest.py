"""Fixtures of the commands' tests."""

import pytest
from sweep_tools import SWEEP

import damperopt


@pytest.fixture(scope="session")
def nose(configs):
    return damperopt.load(configs / "nose_gear_thota.yaml")


@pytest.fixture
def file(configs, tmp_path):
    """A sweep's file of ten quick points."""
    path = tmp_path / "nose.yaml"
    path.write_text(SWEEP.format(base=configs / "nose_gear_thota.yaml"))
    return path
