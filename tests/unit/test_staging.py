"""Folders that are being filled: one process each, nothing left over, nothing lost."""

import os
import subprocess
import sys

import pytest

from damperopt.errors import OutputError
from damperopt.output.folder import run_folder, write_run
from damperopt.output.staging import claim, sweep_up


def test_two_runs_at_once_get_two_folders_without_a_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folders = [run_folder(None, "gear") for _ in range(3)]
    assert len(set(folders)) == 3
    for folder in folders:
        write_run(folder, lambda place: (place / "f").touch())
    assert sorted(f.name for f in (tmp_path / "runs").iterdir()) == sorted(f.name for f in folders)


def test_two_runs_for_one_folder_are_refused_before_the_work(tmp_path):
    first = claim(tmp_path / "run")
    with pytest.raises(OutputError, match="another run is at work"):
        run_folder(tmp_path / "run", "gear")
    first.release()
    assert not list(tmp_path.iterdir())


def test_an_empty_folder_is_filled_where_it_is(tmp_path, monkeypatch):
    from pathlib import Path

    monkeypatch.chdir(tmp_path)
    folder = run_folder(Path("."), "gear")
    write_run(folder, lambda place: (place / "f").touch())
    assert os.listdir() == ["f"]
    assert os.path.samefile(".", tmp_path)


@pytest.mark.parametrize("name", ["x" * 300, "y" * 250])
def test_names_that_are_too_long_are_said_before_the_work_and_long_ones_serve(tmp_path, name):
    if len(name) > 255:
        with pytest.raises(OutputError, match="too long"):
            run_folder(tmp_path / name, "gear")
        return
    write_run(run_folder(tmp_path / name, "gear"), lambda place: (place / "f").touch())
    assert (tmp_path / name / "f").exists()


def test_a_study_with_a_long_name_gets_a_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folder = run_folder(None, "ß" * 300)
    write_run(folder, lambda place: (place / "f").touch())
    assert (folder / "f").exists()


def test_what_a_dead_process_left_is_swept_up_and_what_a_living_one_fills_is_not(tmp_path):
    code = (
        "import os, signal, sys; from pathlib import Path; from damperopt.output.staging import claim\n"
        "claim(Path(sys.argv[1]) / 'dead'); os.kill(os.getpid(), signal.SIGKILL)"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path], check=False)
    alive = claim(tmp_path / "alive")
    assert list(tmp_path.iterdir()) == [alive.staging]  # the claim has swept up already
    sweep_up(tmp_path)
    assert alive.staging.exists()
    alive.release()


def test_results_are_not_lost_where_something_appears_in_their_place(tmp_path):
    folder = run_folder(tmp_path / "run", "gear")

    def write(place):
        (place / "f").touch()
        folder.mkdir()
        (folder / "other").touch()

    with pytest.raises(OutputError, match=r"the results are in .*run-2"):
        write_run(folder, write)
    assert (tmp_path / "run-2" / "f").exists()


def test_a_run_that_writes_nothing_leaves_no_parent(tmp_path):
    code = (
        "import sys; from pathlib import Path; from damperopt.output.folder import run_folder\n"
        "run_folder(Path(sys.argv[1]) / 'a' / 'run', 'gear')"
    )
    subprocess.run([sys.executable, "-c", code, tmp_path], check=True)
    assert not list(tmp_path.iterdir())
