"""A distribution of plug-ins, installed for real; commands and broken plug-ins beside it."""

import json
import subprocess
import sys
from pathlib import Path

import pytest
from beside import TOY, environment

collect_ignore = ["toy"]  # its own tests need it installed


@pytest.fixture(scope="session")
def toy(tmp_path_factory) -> Path:
    """Folder with the toy distribution as pip installs it."""
    place = tmp_path_factory.mktemp("site")
    options = ["--quiet", "--no-deps", "--no-build-isolation", "--no-index", "--target", place]
    subprocess.run([sys.executable, "-m", "pip", "install", *options, TOY], check=True, capture_output=True)
    return place


@pytest.fixture
def commands(tmp_path):
    """Function that runs command lines one after the other in one process beside a folder of distributions."""

    def run(place: Path, *lines: str) -> list[dict]:
        """Code, stdout and stderr of each."""
        script = Path(__file__).parent / "beside.py"
        done = subprocess.run(
            [sys.executable, script],
            input=json.dumps(lines),
            capture_output=True,
            text=True,
            cwd=tmp_path,
            env=environment(place),
        )
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run
