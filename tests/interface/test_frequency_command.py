"""Commands frequency and export: files, counts, round trips with NumPy and SciPy, refusals."""

from __future__ import annotations

import csv
import sys

import numpy as np
import pytest
from memory_twin import F_Z, O, gear, rightmost, study_text
from scipy.io import loadmat

from damperopt import linear_gear, loads


@pytest.fixture
def study(tmp_path):
    path = tmp_path / "o.yaml"
    path.write_text(study_text(gear(O), low=8.0, high=10.0), encoding="utf-8")
    return path


def test_frequency_writes_what_it_shows(call, study, tmp_path, monkeypatch):
    monkeypatch.setattr(sys.modules["damperopt.commands.frequency"], "SPEEDS", 4)
    found = call("frequency", study, "--speed", "8.75,20kt", "-o", tmp_path / "run")
    assert found.code == 0, found.err
    assert "Weakest of" in found.out
    with open(tmp_path / "run" / "margins.csv", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert min(float(row["disk [1]"]) for row in rows) == pytest.approx(0.1431, abs=1e-4)
    table = np.genfromtxt(tmp_path / "run" / "loop-8.75.csv", delimiter=",", names=True)
    assert len(table) > 100
    made = {path.name for path in (tmp_path / "run").iterdir()}
    assert made >= {f"{name}.{end}" for name in ("margins", "loop-8.75", "loop-10.2889") for end in ("csv", "png", "svg")}


@pytest.mark.parametrize("suffix", ["npz", "mat"])
def test_exported_matrices_are_the_gear(call, study, tmp_path, suffix):
    path = tmp_path / f"gear.{suffix}"
    options = ("--speeds", "8:20:4", "--loads", "100kN,150kN", "--order", "12")
    found = call("export", study, "--to", path, *options)
    assert found.code == 0, found.err
    assert "order 12" in found.out
    if suffix == "npz":
        with np.load(path) as file:
            data = dict(file)
        states, A = data["state_names"].tolist(), data["A"][0, 1]
        C, B, delay = data["C"][0, 1], data["B"][0, 1], data["delay_s"][0, 1]
    else:
        data = loadmat(path, simplify_cells=True)
        states, A = list(data["state_names"]), data["A"][:, :, 0, 1]
        C, B, delay = data["C"][:, :, 0, 1], np.atleast_2d(data["B"][..., 0, 1]), np.atleast_1d(data["delay_s"])[..., 0, 1]
    assert states[:2] == ["yaw_angle", "yaw_rate"]
    assert len(states) == 5 + 12
    top = np.linalg.eigvals(A)
    for root in rightmost(8.0, F_Z, gear(O), count=2):
        assert np.abs(top - root).min() < 1e-6 * abs(root)
    exact = linear_gear(loads(study.read_text(encoding="utf-8")), {}).roots(8.0, F_Z)[0]
    assert top.real.max() == pytest.approx(exact.real.max(), rel=1e-6)
    assert np.ravel(delay) == pytest.approx(0.2 / 8.0)
    assert B.reshape(-1)[1] == pytest.approx(1 / gear(O).I_z)
    outputs = list(data["output_names"])
    force = C[outputs.index("damper_torque")]
    assert force[states.index("yaw_rate")] == pytest.approx(O["c_psi"])
    again = call("export", study, "--to", path)
    assert again.code != 0
    assert "exists already" in again.err


def test_exported_delay_is_exact(call, study, tmp_path):
    """Roots of the twin by collocation are eigenvalues of A(lambda), put together as the page of the documentation says."""
    path = tmp_path / "gear.npz"
    assert call("export", study, "--to", path, "--speeds", "8:8:1").code == 0
    with np.load(path) as file:
        A_0, b, delay = (file[f"delay_{name}"][0, 0] for name in ("A_0", "b", "s"))
        line = dict(zip(file["delay_footprint_names"].tolist(), file["delay_footprint"][0, 0, 0], strict=True))
    for root in rightmost(8.0, F_Z, gear(O), count=4):
        z = root * delay[0]
        E = np.exp(-z)
        phi1 = (1 - E) / z
        chi = (1 + E) / z - 2 * phi1 / z
        A = A_0.astype(complex)
        for k, (name, last) in enumerate((("force", phi1), ("moment", chi))):
            A[:, -1] += b[:, k] * sum(line[f"{name}[{i}]"] * part for i, part in enumerate((1, E, last)))
        assert np.abs(np.linalg.eigvals(A) - root).min() < 1e-8 * abs(root)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("frequency", "--break", "wheel"), "--break: found 'wheel'; allowed: tyre or damper"),
        (("frequency", "--speed", "5,-3"), "--speed:"),
        (("frequency", "--speed", "5,"), "--speed:"),
        (("frequency", "--load", "7 kg"), "--load:"),
        (("export", "--to", "a.csv"), "--to: found 'a.csv'; allowed: a file that ends with .npz or .mat"),
        (("export", "--to", "a.npz", "--loads", "20kN,"), "--load"),
        (("export", "--to", "a.npz", "--speeds", "5"), "--speeds: found '5'"),
    ],
)
def test_what_is_refused(call, study, arguments, words):
    command, *options = arguments
    found = call(command, study, *options)
    assert found.code == 2
    assert words in found.err
