"""The command line starts quickly: help waits for no library of the work."""

import subprocess
import sys

import pytest

HEAVY = ("casadi", "matplotlib", "numpy", "pint", "scipy")
COMMANDS = ("optimise", "report", "analyse", "simulate", "breakout", "chart", "sweep", "thesis", "validate", "init", "schema")
ASK = f"""
import sys
from damperopt.cli import main
try:
    main()
finally:
    print("loaded:", *[name for name in {HEAVY} if name in sys.modules], file=sys.stderr)
"""


def help_of(*command):
    return subprocess.run([sys.executable, "-c", ASK, *command, "--help"], capture_output=True, text=True, timeout=60)


@pytest.mark.parametrize("command", [(), *((name,) for name in COMMANDS)], ids=" ".join)
def test_help_loads_no_library_of_the_work(command):
    """None of the heavy libraries is imported by the time that help is printed."""
    done = help_of(*command)
    assert done.returncode == 0, done.stderr
    assert done.stderr.strip() == "loaded:"


def test_help_lists_every_command_and_keeps_brackets():
    """Every command stands in the list with its words; brackets in the words of an option are not taken for markup."""
    listed = help_of().stdout
    for name in COMMANDS:
        assert f"\n  {name} " in listed
    assert "Arreaza's thesis" in listed
    assert "damperopt[cluster]" in help_of("sweep").stdout
    assert "[default: 12 cycles" in help_of("simulate").stdout


def test_as_a_module():
    """`python -m damperopt` is the same command."""
    done = subprocess.run([sys.executable, "-m", "damperopt", "--version"], capture_output=True, text=True, timeout=60)
    assert done.stdout.startswith("damperopt 0.")
