"""Fixtures of the commands' tests."""

import sys
from types import SimpleNamespace

import pytest
from sweep_tools import SWEEP

import damperopt
from damperopt import cli


@pytest.fixture(scope="session")
def nose(configs):
    return damperopt.load(configs / "nose_gear_thota.yaml")


@pytest.fixture
def file(configs, tmp_path):
    """A sweep's file of ten quick points."""
    path = tmp_path / "nose.yaml"
    path.write_text(SWEEP.format(base=configs / "nose_gear_thota.yaml"))
    return path


@pytest.fixture
def call(monkeypatch, capsys, tmp_path):
    """A command in this process and without compilation, in an empty folder: exit code and what it prints."""
    monkeypatch.setattr("damperopt.motion.integrators.has_compiler", lambda: False)
    monkeypatch.chdir(tmp_path)

    def run(*arguments):
        monkeypatch.setattr(sys, "argv", ["damperopt", *map(str, arguments)])
        with pytest.raises(SystemExit) as end:
            cli.main()
        said = capsys.readouterr()
        return SimpleNamespace(code=end.value.code or 0, out=said.out, err=said.err)

    return run
