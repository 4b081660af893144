"""What an actuator saves of a damper's mass: the best passive damper against the best that is safe without its actuator.

The numbers of the page "Active damping": `python benchmarks/active.py` (minutes).
"""

from pathlib import Path

import damperopt

CONFIGS = Path(__file__).parent.parent / "configs"

GAINS = {"yaw_rate": {"constant": 842.741, "linear": 49.6916, "quadratic": -0.428197}}
"""Of the main gear: `damperopt gains` with the sizes 1 mrad and 0.1 rad/s, 100 N m, yaw rate alone."""

OILS = {"20 degC": None, "-40 to 70 degC": {"temperature": {"min": 233.15, "max": 343.15}}}


def studies():
    """Name and study with its actuator, each at one temperature and over a range of them."""
    main = damperopt.load(CONFIGS / "main_gear.yaml").replace(requirements__decay=None, solver__starts=1)
    control = {"gains": GAINS, "lag": 5e-3}
    main = main.replace(damper__control=control, requirements__fail_safe_margin=0.1)
    nose = damperopt.load(CONFIGS / "nose_gear_active.yaml")
    for name, study in (("nose gear", nose), ("main gear", main)):
        for oil, block in OILS.items():
            yield f"{name}, {oil}", study if block is None else study.replace(damper__oil=block)


def answers(study):
    """The study with its actuator, and the passive one that meets all of its requirements."""
    return damperopt.optimise(study), damperopt.optimise(study.without_control())


def main():
    """Masses side by side."""
    for name, study in studies():
        active, passive = answers(study)
        for kind, result in (("with an actuator", active), ("passive", passive)):
            mass = "none" if result.mass is None else f"{result.mass.total:.3f} kg"
            print(f"{name}, {kind}: {result.status}, {mass}, c_lambda {result.design.get('c_lambda', 0):.4g} N s/m", flush=True)


if __name__ == "__main__":
    main()
