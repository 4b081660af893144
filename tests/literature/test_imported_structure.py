"""A structure as matrices: the fifth order as two coordinates, a beam as three; files, units, and what is refused."""

from __future__ import annotations

from pathlib import Path

import jsonschema
import numpy as np
import pytest
import yaml
from scipy.linalg import eigvals
from table_gear import assert_printed, eigenvalues, table_gear

from damperopt import ConfigError, Study, joint_boundary, json_schema, loads, optimise, simulate
from damperopt.stability.linear import linear_gear

E_T, L_G, R_W, F, V = 0.12, 2.5, 0.362, 150e3, 40.0
TWO = {
    "M": [[100.0, 0.0], [0.0, 600.0]],
    "C": [[0.0, 0.0], [0.0, 300.0]],
    "K": [[0.0, 0.0], [0.0, 6.1e6]],
    "K_g": [[0.0, 0.0], [-E_T, 0.0]],
    "H_eta": [-E_T, -L_G],
    "H_theta": [1.0, 0.0],
}


def beam(lower=0.0):
    """Cantilever of tip stiffness k_delta/l^2, condensed to (psi, w, slope) at its tip."""
    EI = 6.1e6 * 2.5 / 3
    K = np.zeros((3, 3))
    K[1:, 1:] = EI / L_G**3 * np.array([[12, -6 * L_G], [-6 * L_G, 4 * L_G**2]])
    K_g = np.zeros((3, 3))
    K_g[1, 0] = -E_T / L_G
    M = np.diag([100.0, 96.0, 15.0])
    return {"M": M, "C": 300 / 6.1e6 * K, "K": K, "K_g": K_g, "H_eta": [-E_T, -1.0, -lower], "H_theta": [1.0, 0.0, 0.0]}


def lists(structure):
    return {name: np.asarray(value).tolist() if name != "names" else value for name, value in structure.items()}


def imported(structure, stiffness=3.8e5, damping=300.0, rake=0.0):
    study = table_gear(stiffness, damping, rake_angle=rake)
    gear = {"kind": "imported", "wheel_radius": R_W, "structure": lists(structure)}
    return Study.model_validate({**study.model_dump(exclude_none=True), "gear": gear})


@pytest.mark.parametrize("speed", [7.0, 40.0, 110.0])
def test_two_coordinates_are_the_fifth_order(speed):
    np.testing.assert_allclose(eigenvalues(imported(TWO), speed), eigenvalues(table_gear(), speed), rtol=1e-12)


def test_rows_of_a_strut_with_rake_are_no_transposes():
    phi = 0.1571
    c, s = np.cos(phi), np.sin(phi)
    e = E_T * c + (R_W + E_T * s) * s / c
    rows = {"H_eta": [-e * c, -L_G], "H_theta": [c, 0.0], "B_F": [-e, -L_G * c], "B_M": [1.0, 0.0], "H_d": [1.0, 0.0]}
    structure = TWO | rows | {"K_g": [[-s * e * c, 0.0], [-e * c, 0.0]]}
    found = eigenvalues(imported(structure), V)
    np.testing.assert_allclose(found, eigenvalues(table_gear(rake_angle=phi), V), rtol=1e-11)
    assert_printed(found, [1.32006 + 70.8745j])
    transposes = {name: value for name, value in structure.items() if name not in ("B_F", "B_M")}
    assert_printed(eigenvalues(imported(transposes), V), [1.28936 + 70.7669j])


def test_spinning_wheel_as_a_gyroscopic_matrix():
    G = 6.0 / R_W * np.array([[0.0, -1.0], [1.0, 0.0]])
    found = eigenvalues(imported(TWO | {"G": G}), 100.0)
    np.testing.assert_allclose(found, eigenvalues(table_gear(wheel_polar_inertia=6.0), 100.0), rtol=1e-12)


def test_beam():
    printed = [2.25066 + 70.7684j, -0.250897 + 98.0884j, -14.0973 + 757.019j, -140.947]
    assert_printed(eigenvalues(imported(beam()), V), printed)
    printed = [2.22289 + 70.7714j, -0.303817 + 98.1413j, -14.1004 + 757.037j, -140.78]
    assert_printed(eigenvalues(imported(beam(R_W)), V), printed)


def test_any_coordinates_of_the_same_structure_give_the_same_gear():
    """q = S r with a full S: eigenvalues stay, and yaw and lateral motion after a release are those of the first."""
    S = np.array([[0.3, 1.1, -0.2], [0.7, -0.4, 0.5], [0.1, 0.2, 0.9]])
    first = beam(R_W)
    other = {name: S.T @ np.asarray(first[name]) @ S for name in ("M", "C", "K", "K_g")}
    other |= {name: np.asarray(first[name]) @ S for name in ("H_eta", "H_theta")}
    one, two = imported(first), imported(other)
    np.testing.assert_allclose(eigenvalues(two, V), eigenvalues(one, V), rtol=1e-8)
    assert two.gear.yaw_inertia == pytest.approx(one.gear.yaw_inertia)
    motions = [simulate(study, speed=V, disturbance={"kick": {"yaw_rate": 0.1}}, duration=0.2) for study in (one, two)]
    times = np.linspace(0, 0.2, 50)
    for name in ("yaw_angle", "lateral_displacement"):
        a, b = (np.interp(times, motion.time, motion[name]) for motion in motions)
        np.testing.assert_allclose(b, a, rtol=0, atol=2e-3 * np.abs(a).max())  # of linear interpolation


def test_damper_at_another_angle_against_matrices_written_out():
    """H_d: torque k (H_d q) on H_d'."""
    H_d = np.array([1.0, -0.4, 0.1])
    b, k, c = beam(R_W), 3.8e5, 300.0
    M, C = np.asarray(b["M"]), b["C"] + c * np.outer(H_d, H_d)
    K = b["K"] + F * b["K_g"] + k * np.outer(H_d, H_d)
    H_eta, H_theta, sigma, a = np.array(b["H_eta"]), np.array(b["H_theta"]), 0.3, 0.1
    C = C + 570.0 / V * np.outer(H_theta, H_theta)
    B = (F / sigma * (0.014 * H_eta - 1.0 * H_theta))[:, None]
    Z, one = np.zeros((3, 3)), np.eye(3)
    left = np.block([[one, Z, np.zeros((3, 1))], [Z, M, np.zeros((3, 1))], [np.zeros((1, 6)), np.ones((1, 1))]])
    string = np.hstack([V * H_theta, -H_eta - a * H_theta, [-V / sigma]])
    expected = eigvals(np.vstack([np.hstack([Z, one, np.zeros((3, 1))]), np.hstack([-K, -C, B]), string]), left)
    found = eigenvalues(imported({**b, "H_d": H_d}), V)
    np.testing.assert_allclose(found, sorted(expected[expected.imag >= 0], key=lambda v: -v.real), rtol=1e-9)


def test_joint_boundary_is_where_the_damper_acts():
    study = imported({**beam(R_W), "H_d": [1.0, -0.4, 0.1]})
    k, c = joint_boundary(study, V, F, np.array([11.0, 13.0]), margin=0.2)
    A, with_k, with_c = (
        linear_gear(imported({**beam(R_W), "H_d": [1.0, -0.4, 0.1]}, *pair)).matrices(V, F)[0]
        for pair in ((0.0, 0.0), (1e5, 0.0), (0.0, 1e3))
    )
    for stiffness, damping, frequency in zip(k, c, (11.0, 13.0), strict=True):
        made = A + stiffness / 1e5 * (with_k - A) + damping / 1e3 * (with_c - A)
        wanted = complex(-0.2, 2 * np.pi * frequency)
        assert np.abs(np.linalg.eigvals(made) - wanted).min() < 1e-6 * abs(wanted)


# files

UNITS = "length=mm, force=N, time=s"


def in_millimetres(structure):
    """The same numbers as a code with N, mm, s has them: energies in N mm."""
    factor = {"M": 1e3, "C": 1e3, "K": 1e3, "K_g": 1e3, "H_eta": 1e3}
    return {name: factor.get(name, 1.0) * np.asarray(value) for name, value in structure.items()}


def study_text(configs, name):
    text = (configs / "nose_gear_somieski.yaml").read_text(encoding="utf-8")
    start, end = text.index("\ngear:") + 1, text.index("\ntyre:") + 1
    gear = f"gear: {{kind: imported, wheel_radius: 0.362 m, structure: {{file: {name}}}}}\n\n"
    return text[:start] + gear + text[end:]


def write_npz(folder, structure, **more):
    np.savez(folder / "frame.npz", **in_millimetres(structure), **{"units": UNITS, **more})


def write_csv(folder, structure, units=UNITS):
    (folder / "frame").mkdir()
    for name, value in in_millimetres(structure).items():
        np.savetxt(folder / "frame" / f"{name}.csv", np.atleast_2d(value), delimiter=",", header=units)


def read(folder, configs, name):
    file = folder / "study.yaml"
    file.write_text(study_text(configs, name), encoding="utf-8")
    from damperopt import load

    return load(file)


def test_files_are_looked_for_beside_the_study_and_converted(tmp_path, configs):
    write_npz(tmp_path, beam(R_W), names=["swivel", "side", "slope"])
    write_csv(tmp_path, beam(R_W))
    for name in ("frame.npz", "frame"):
        gear = read(tmp_path, configs, name).gear
        assert gear.structure.source == name
        for key, value in lists(beam(R_W)).items():
            np.testing.assert_allclose(getattr(gear.structure, key), value, rtol=1e-12, atol=1e-12)
    names = {state.freedom for state in read(tmp_path, configs, "frame.npz").gear.states()}
    assert names == {"yaw", "side", "slope"}


def test_a_study_that_was_read_needs_no_file_any_more(tmp_path, configs):
    write_npz(tmp_path, TWO)
    study = read(tmp_path, configs, "frame.npz")
    (tmp_path / "frame.npz").unlink()
    assert Study.model_validate_json(study.model_dump_json(exclude_none=True)) == study
    assert study.replace(envelope__speed__max=90.0).gear == study.gear


def test_schema_takes_the_file_or_the_numbers(configs):
    schema = jsonschema.Draft202012Validator(json_schema())
    data = yaml.safe_load(study_text(configs, "frame.npz"))
    schema.validate(data)
    data["gear"]["structure"] = lists(TWO)
    schema.validate(data)
    del data["gear"]["structure"]["K"]
    assert not schema.is_valid(data)


def changed(**keys):
    return {name: value for name, value in (beam() | keys).items() if value is not None}


WRONG = {
    "no file": (None, r"structure\.file: .*frame.npz cannot be read"),
    "no K": (changed(K=None), r"frame\.npz lacks K; allowed: all of M, C, K, H_eta, H_theta"),
    "unknown": (changed(X=np.eye(3)), r"frame\.npz holds 'X'; allowed: M, C, K"),
    "shape": (changed(K=np.eye(2)), r"structure\.K: the shape \(2, 2\); allowed: \(3, 3\), as M has 3 rows"),
    "row": (changed(H_eta=np.ones(2)), r"structure\.H_eta: the shape \(2,\); allowed: \(3,\)"),
    "not finite": (changed(H_eta=np.array([np.nan, 1, 1])), r"H_eta of frame\.npz is not finite everywhere"),
    "complex": (changed(K=np.eye(3) * 1j), r"K of frame\.npz holds no real numbers"),
    "mass": (
        changed(M=np.diag([1.0, -1.0, 1.0])),
        r"structure\.M: the eigenvalue -1 beside 1; allowed: positive definite",
    ),
    "massless": (
        changed(M=np.diag([1.0, 0.0, 1.0])),
        r"structure\.M: the eigenvalue 0 beside 1; allowed: positive definite",
    ),
    "stiffness": (changed(K=np.diag([1.0, -1e3, 1e6])), r"structure\.K: the eigenvalue .*allowed: no negative eigenvalue"),
    "damping": (changed(C=np.diag([1.0, -1e3, 1e6])), r"structure\.C: the eigenvalue .*allowed: no negative eigenvalue"),
    "asymmetric": (changed(K=np.triu(np.ones((3, 3)))), r"structure\.K: not symmetric; allowed: K = K'"),
    "gyroscopic": (changed(G=np.eye(3)), r"structure\.G: not antisymmetric; allowed: G = -G'"),
    "no swivel": (changed(H_theta=np.zeros(3)), r"structure\.H_theta: nothing but zeros"),
    "large": (
        {"M": np.eye(61), "C": np.eye(61), "K": np.eye(61), "H_eta": np.ones(61), "H_theta": np.ones(61)},
        r"structure\.M: 61 coordinates; allowed: at most 60: condense",
    ),
    "names": (changed(names=["a", "a", "b"]), r"structure\.names: 3 names, 2 of them different"),
    "units": (changed(units="kg"), r"frame\.npz says 'kg' as its units; allowed: such as 'length=mm"),
    "no units": (changed(units=""), r"frame\.npz states no units"),
    "unit": (changed(units="length=mm, force=mm, time=s"), r"gives 'mm' as its unit of force"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_files_are_refused_with_one_message(case, tmp_path, configs):
    structure, message = WRONG[case]
    if structure is not None:
        text = {name: structure.pop(name) for name in ("names", "units") if name in structure}
        numbers = {name: np.asarray(value) for name, value in structure.items()}
        np.savez(tmp_path / "frame.npz", **{name: 1e3 * value for name, value in numbers.items()}, **({"units": UNITS} | text))
    with pytest.raises(ConfigError, match=message) as found:
        read(tmp_path, configs, "frame.npz")
    assert len(found.value.problems) == 1


def test_wrong_folders_are_refused(tmp_path, configs):
    with pytest.raises(ConfigError, match=r"is no \.npz file and no folder of \.csv files"):
        read(tmp_path, configs, "frame")
    write_csv(tmp_path, TWO)
    K = tmp_path / "frame" / "K.csv"
    K.write_text(K.read_text(encoding="utf-8").replace("mm", "m"), encoding="utf-8")
    with pytest.raises(ConfigError, match=r"the units of frame differ"):
        read(tmp_path, configs, "frame")
    K.write_text(f"# {UNITS}\n1, two\n3, 4\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"K\.csv is no table of numbers"):
        read(tmp_path, configs, "frame")
    K.write_text(f"# {UNITS}\n1, 2\n3\n", encoding="utf-8")
    with pytest.raises(ConfigError, match=r"K\.csv is no table of numbers"):
        read(tmp_path, configs, "frame")


def test_numbers_beside_what_follows_from_the_matrices_are_refused():
    gear = {"kind": "imported", "wheel_radius": R_W, "structure": lists(TWO), "yaw_inertia": 90.0}
    base = table_gear().model_dump(exclude_none=True)
    with pytest.raises(ValueError, match=r"found 90\.0 beside matrices that say 100; allowed: to leave it out"):
        Study.model_validate({**base, "gear": gear})
    ragged = {**gear, "structure": {**lists(TWO), "K": [[1.0, 2.0], [3.0]]}}
    with pytest.raises(ValueError, match=r"rows of different lengths"):
        Study.model_validate({**base, "gear": ragged})


@pytest.mark.slow
def test_lightest_damper_of_an_imported_gear_is_that_of_the_fifth_order(main_gear):
    base = main_gear.model_dump(exclude_none=True)
    gear = {"kind": "imported", "wheel_radius": R_W, "structure": lists(TWO)}
    one, other = optimise(main_gear), optimise(Study.model_validate({**base, "gear": gear}))
    assert one.status == other.status == "solved"
    assert other.mass.total == pytest.approx(one.mass.total, rel=1e-6)


def test_file_is_named_from_where_the_text_is(configs, monkeypatch, tmp_path):
    write_npz(tmp_path, TWO)
    monkeypatch.chdir(tmp_path)
    assert loads(study_text(configs, "frame.npz")).gear.structure.source == "frame.npz"
    assert Path("frame.npz").exists()
