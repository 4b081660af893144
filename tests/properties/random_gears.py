"""Gears for the property tests: rotational studies with given or random numbers, and brute force on dense grids."""

import numpy as np
from scipy.optimize import minimize_scalar

LINEAR_TYRE = {
    "law": "linear",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "tread_width_moment": 570.0,
    "cornering_slope": 0.014,
    "aligning_coefficient": 1.0,
}
"""Tyre of thesis Table 0.1 (slope 7 C_F), linear."""

STRAIGHT_TANGENT_TYRE = {
    "law": "stiffness",
    "contact": "leading_point",
    "half_contact_length": 0.1,
    "relaxation_length": 0.3,
    "tread_width_moment": 570.0,
    "cornering_stiffness": 2100.0,
    "aligning_stiffness": 1.5e5,
}
"""The same tyre at 150 kN, by the straight-tangent law."""

LATERAL = {"inertia": 600.0, "stiffness": 6.1e6, "damping": 300.0, "height": 2.5}


def rotational(base, speed=(5.0, 100.0), load=1.5e5, stiffness=3.8e5, damping=300.0, tyre=None, lateral=None, **gear):
    """Study with stiffness and damping about the yaw axis given directly; other numbers from Table 0.1 unless named.

    `load` is a number, a list, or a pair (min, max) for a continuous range.
    """
    order = gear.pop("order", 5)
    return base.replace(
        gear={
            "order": order,
            "yaw_inertia": 100.0,
            "caster_length": 0.12,
            "rake_angle": 0.0,
            "wheel_radius": 0.362,
            "lateral": LATERAL | (lateral or {}) if order == 5 else None,
            **gear,
        },
        tyre=LINEAR_TYRE | (tyre or {}) if (tyre or {}).get("law", "linear") == "linear" else tyre,
        damper={"topology": "rotational", "torsional_stiffness": stiffness, "torsional_damping": damping},
        envelope={
            "speed": {"min": speed[0], "max": speed[1]},
            "vertical_load": {"min": load[0], "max": load[1]} if isinstance(load, tuple) else load,
        },
    )


def random_gear(rng, base, order=None, spread=1.0, **changes):
    """A legal gear at random: the numbers of Table 0.1 times up to 3^spread either way, both signs where both are legal.

    One in ten has no damping, one in ten no stiffness; 40 % have rake; all three tyre laws occur.
    """

    def near(value, factor=3.0):
        return float(value * factor ** (spread * rng.uniform(-1, 1)))

    def sign():
        return float(rng.choice([1, 1, 1, -1]))

    law = str(rng.choice(["nonlinear", "linear", "stiffness"], p=[0.5, 0.25, 0.25]))
    tyre = {
        "law": law,
        "contact": "leading_point",
        "half_contact_length": near(0.1),
        "relaxation_length": near(0.3),
        "tread_width_moment": near(570.0) * float(rng.random() < 0.8),
    }
    if law == "nonlinear":
        tyre |= {
            "cornering_coefficient": near(0.002, 5.0),
            "aligning_coefficient": near(1.0) * sign(),
            "aligning_slip_limit": 0.17,
        }
    elif law == "linear":
        tyre |= {"cornering_slope": near(0.014, 5.0), "aligning_coefficient": near(1.0) * sign()}
    else:
        tyre |= {"cornering_stiffness": near(2100.0, 5.0), "aligning_stiffness": near(1.5e5) * sign()}
    low = float(np.exp(rng.uniform(np.log(0.5), np.log(20.0))))
    numbers = {
        "order": order or int(rng.choice([3, 5])),
        "yaw_inertia": near(100.0),
        "caster_length": near(0.12) * sign(),
        "rake_angle": float(rng.uniform(-0.3, 0.3)) if rng.random() < 0.4 else 0.0,
        "lateral": {
            "inertia": near(600.0),
            "stiffness": near(6.1e6, 5.0),
            "damping": near(3e3, 30.0),
            "height": near(2.5, 2.0),
        },
        "stiffness": near(3.8e5, 5.0) * float(rng.random() < 0.9),
        "damping": near(1.5e3, 10.0) * float(rng.random() < 0.9),
        "tyre": tyre,
        "speed": (low, low * float(np.exp(rng.uniform(np.log(1.5), np.log(100.0))))),
        "load": near(1.5e5),
    }
    return rotational(base, **(numbers | changes))


def extreme_gear(rng, base, kind):
    """A gear at the edge of what is legal: 0.01 to 1000 m/s, 1 N to 10 MN, rake to 60 deg; `kind` 0..4 goes further."""
    gear = random_gear(
        rng,
        base,
        spread=float(rng.choice([1.0, 4.0])),
        speed=(0.01, 1000.0),
        load=float(10 ** rng.uniform(0, 7)),
        rake_angle=float(rng.choice([0.0, np.pi / 3, -np.pi / 3, rng.uniform(-1, 1)])),
    )
    changes = {
        0: {},
        1: {"gear__yaw_inertia": float(10 ** rng.uniform(-9, 0))},
        2: {"gear__lateral__inertia": float(10 ** rng.uniform(-9, 0))} if gear.gear.order == 5 else {},
        3: {"damper__torsional_damping": 0.0, "tyre__tread_width_moment": 0.0},
        4: {"damper__torsional_stiffness": 0.0},
    }[kind]
    return gear.replace(**changes)


def dense(low, high, count):
    """Speeds or loads, `count` spaced evenly and `count` geometrically, both ends exactly."""
    return np.clip(np.union1d(np.linspace(low, high, count), np.geomspace(low, high, count)), low, high)


def brute_force(gear, speeds, loads):
    """(abscissa, speed, load) where the spectral abscissa is largest on a grid."""
    V, F_z = (grid.ravel() for grid in np.meshgrid(speeds, loads))
    height = gear.abscissa(V, F_z)
    top = int(height.argmax())
    return float(height[top]), float(V[top]), float(F_z[top])


def refined_maximum(abscissa, low, high, count=300):
    """(abscissa, speed): the largest value over a closed range, the three best cells of a dense grid refined.

    `abscissa` maps an array of speeds to an array.
    """
    speeds = dense(low, high, count)
    height = abscissa(speeds)
    best = [(float(height.max()), float(speeds[height.argmax()]))]
    inner = np.flatnonzero((height[1:-1] >= height[:-2]) & (height[1:-1] >= height[2:])) + 1
    for i in inner[np.argsort(-height[inner])][:3]:
        found = minimize_scalar(
            lambda V: -float(abscissa(np.array([V]))[0]),
            bounds=(speeds[i - 1], speeds[i + 1]),
            method="bounded",
            options={"xatol": 1e-10 * high},
        )
        best.append((-float(found.fun), float(found.x)))
    return max(best)


def refined_maximum_2d(gear, speed, load, count=40, rounds=30):
    """(abscissa, speed, load): the largest value over a rectangle, by a grid that zooms in on its best cell.

    Meant for gears with one peak that a 40 by 40 grid sees.
    """
    box = np.array([speed, load], float)
    bounds = box.copy()
    for _ in range(rounds):
        top, V, F_z = brute_force(gear, np.linspace(*box[0], count), np.linspace(*box[1], count))
        reach = (box[:, 1] - box[:, 0]) / 4
        centre = np.array([V, F_z])
        box = np.clip(np.array([centre - reach, centre + reach]).T, bounds[:, :1], bounds[:, 1:])
        count = 9
    return top, V, F_z


def ends(study):
    return study.envelope.speed.min, study.envelope.speed.max


def eigenvalues(gear, speed, load):
    return np.linalg.eigvals(gear.matrices(speed, load)[0])
