"""What an actuator saves of a damper's mass: the best passive damper against the best that is safe without its actuator.

    python benchmarks/active.py [--only 'nose gear']

The numbers of the page "Active damping" (minutes). The main gear has no decay requirement here, for speed.
"""

import argparse
from pathlib import Path

import damperopt

CONFIGS = Path(__file__).parent.parent / "configs"

GAINS = {"yaw_rate": {"constant": 842.741, "linear": 49.6916, "quadratic": -0.428197}}
"""Of the main gear: `damperopt gains` with the sizes 1 mrad and 0.1 rad/s, 100 N m, yaw rate alone."""

OILS = {"20 degC": {}, "-54 to 70 degC": {"damper__oil": {"temperature": {"min": 219.15, "max": 343.15}}}}
"""Over a range a larger reserve is left to the margin: where a root only just keeps it, a proof cannot decide."""

RESERVE = {"solver__margin_reserve": 1e-3}


def studies():
    """Name and study with its actuator, each at one temperature and over a range of them."""
    main = damperopt.load(CONFIGS / "main_gear.yaml").replace(requirements__decay=None, solver__starts=1)
    control = {"gains": GAINS, "lag": 5e-3}
    main = main.replace(damper__control=control, requirements__fail_safe_margin=0.1)
    nose = damperopt.load(CONFIGS / "nose_gear_active.yaml")
    for name, study in (("nose gear", nose), ("main gear", main)):
        for oil, block in OILS.items():
            yield f"{name}, {oil}", study.replace(**block, **RESERVE) if block else study


def answers(study):
    """The study with its actuator, and the passive one that meets all of its requirements."""
    return damperopt.optimise(study), damperopt.optimise(study.without_control())


def main():
    """Masses side by side."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", default="", help="Studies whose name holds this.")
    only = parser.parse_args().only
    for name, study in studies():
        if only not in name:
            continue
        active, passive = answers(study)
        for kind, result in (("with an actuator", active), ("passive", passive)):
            mass = "none" if result.mass is None else f"{result.mass.total:.3f} kg"
            print(f"{name}, {kind}: {result.status}, {mass}, c_lambda {result.design.get('c_lambda', 0):.4g} N s/m", flush=True)


if __name__ == "__main__":
    main()
