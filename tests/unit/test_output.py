"""Files: atomic folders, results that survive the round trip, figures that hold what they promise."""

import json

import matplotlib.pyplot as plt
import numpy as np
import pytest

import damperopt
from damperopt import figures as plots
from damperopt.optimum.region import feasible_region
from damperopt.output import folder as output
from damperopt.stability.linear import LinearModel
from damperopt.stability.screening import worst_abscissae_of


@pytest.fixture(scope="module")
def solved(main_gear):
    study = main_gear.replace(damper__topology="boeing", solver__starts=3)
    return study, damperopt.optimise(study)


def test_result_survives_the_round_trip(solved, tmp_path):
    _, result = solved
    (tmp_path / "result.json").write_text(result.to_json())
    assert damperopt.load_result(tmp_path) == result
    assert damperopt.load_result(tmp_path / "result.json").design == result.design  # every digit


@pytest.mark.parametrize("text", ["", "{}", "[]", "\x00", '{"schema_version": 2}'])
def test_other_files_are_no_results(text, tmp_path):
    (tmp_path / "r.json").write_text(text)
    with pytest.raises(damperopt.ConfigError, match="allowed: a result"):
        damperopt.load_result(tmp_path / "r.json")


def test_config_in_the_result_is_the_study(solved):
    study, result = solved
    assert damperopt.Study.model_validate(result.config) == study


def test_failed_writing_leaves_nothing(tmp_path):
    folder = output.run_folder(tmp_path / "a" / "run", "x")

    def write(place):
        (place / "half").write_text("...")
        raise OSError(28, "No space left on device")

    with pytest.raises(damperopt.OutputError, match="No space left"):
        output.write_run(folder, write)
    assert not (tmp_path / "a").exists()  # nor the parent that was made for it


def test_existing_results_are_not_overwritten(tmp_path):
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "result.json").write_text("precious")
    with pytest.raises(damperopt.OutputError, match="exists already"):
        output.run_folder(tmp_path / "run", "x")


def test_two_runs_in_one_second_get_two_folders(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    folders = []
    for _ in range(3):
        folder = output.run_folder(None, "Main gear/№1")
        output.write_run(folder, lambda place: (place / "f").touch())
        folders.append(folder)
    assert len(set(folders)) == 3
    assert all(folder.parent.name == "runs" for folder in folders)


def test_json_has_no_nan(solved):
    assert "NaN" not in solved[1].to_json()
    json.loads(solved[1].to_json(), parse_constant=pytest.fail)


def test_figures_have_axes_with_names_and_units(solved, tmp_path):
    study, result = solved
    open_before = plt.get_fignums()
    speeds = np.linspace(5, 100, 50)
    before = damperopt.track_modes(damperopt.linear_gear(study), speeds, 150e3)
    after = damperopt.track_modes(damperopt.linear_gear(study, result.design), speeds, 150e3)
    drawn = {
        "modes": plots.modes_before_after(before, after, 0.1),
        "single": plots.modes_over_speed(before, 0.1, "title"),
        "mass": plots.mass_by_part(result),
        "region": plots.region(feasible_region(study, result.design, points=41)),
    }
    for name, figure in drawn.items():
        labels = [label for axis in figure.axes for label in (axis.get_xlabel(), axis.get_ylabel()) if label]
        assert labels, name
        assert all("[" in label and label.endswith("]") for label in labels), labels
        for path in plots.save(figure, tmp_path, name):
            assert path.stat().st_size > 5000
    assert plt.get_fignums() == open_before


def test_optimum_lies_on_the_edge_of_its_feasible_region(solved):
    study, result = solved
    region = feasible_region(study, result.design, [(result.stability.speed, result.stability.load)], points=81)
    middle = 40
    near = region.feasible[middle - 3 : middle + 4, middle - 3 : middle + 4]
    assert near.any()
    assert not near.all()
    lighter = region.mass < result.mass.total * (1 - 1e-3)
    assert not (region.feasible & lighter).any()


def test_region_is_stable_where_eigenvalues_say_so(solved):
    study, result = solved
    region = feasible_region(study, result.design, points=15)
    speeds = np.geomspace(5, 100, 24)
    model = LinearModel(study)
    for i, y in enumerate(region.y):
        for j, x in enumerate(region.x):
            design = result.design | {region.x_name: x, region.y_name: y}
            assert (region.stability[i, j] > 0) == (model.at(design).abscissa(speeds, 150e3).max() < -0.1)


def test_records_of_certificate_and_point_come_back_as_they_were(solved):
    again = damperopt.DesignResult.model_validate_json(solved[1].to_json())
    assert again.certificate == solved[1].certificate
    assert again.stability == solved[1].stability
    assert isinstance(again.certificate, damperopt.Certificate)


def test_region_of_an_elastic_gear_has_the_signs_of_every_node(configs):
    """Nodes away from the limit are not looked at one by one, and yet tell what their eigenvalues would."""
    study = damperopt.load(configs / "main_gear.yaml").replace(requirements__decay=None, requirements__damping_ratio=None)
    design = study.start | {"c_lambda": 1.5e4, "I_arm": 1.2e-6, "L": 0.53, "gamma": 0.69, "b": 0.17, "A_piston": 4e-4}
    region = feasible_region(study, design, points=18)
    X, Y = np.meshgrid(region.x, region.y)
    designs = np.tile(list(design.values()), (X.size, 1))
    designs[:, 0], designs[:, 1] = X.ravel(), Y.ravel()
    stable = worst_abscissae_of(LinearModel(study), study, designs) < -0.1
    assert 20 < stable.sum() < X.size - 20
    assert ((region.stability > 0).ravel() == stable).all()
