"""The gear with a steering collar against eigenvalues of an independent prototype, written with matrices alone."""

import numpy as np

import damperopt

STUDY = """
name: collar
gear:
  {kind: steering_collar, yaw_inertia: 100 kg m^2, caster_length: 0.12 m, wheel_radius: 0.362 m,
   lateral: {inertia: 600 kg m^2, stiffness: 6.1e6 N m/rad, damping: 300 N m s/rad, height: 2.5 m},
   collar: {inertia: 5 kg m^2, link_stiffness: 5e5 N m/rad,
            steering_stiffness: 1.5e6 N m/rad, steering_damping: 2000 N m s/rad}}
tyre:
  {law: arctangent, contact: leading_point, half_contact_length: 0.1 m, relaxation_length: 0.3 m,
   cornering_coefficient: 0.002 1/rad, aligning_coefficient: 1 m/rad, aligning_slip_limit: 10 deg,
   tread_width_moment: 570 N m^2/rad}
damper: {topology: rotational, torsional_stiffness: 0 N m/rad, torsional_damping: 300 N m s/rad}
envelope: {speed: {min: 5 m/s, max: 100 m/s}, vertical_load: 150 kN}
"""
PUBLISHED = [1.65557 + 70.3613j, -0.279581 + 100.875j, -140.989, -199.369 + 600.84j]


def test_eigenvalues_at_40_metres_per_second():
    gear = damperopt.linear_gear(damperopt.loads(STUDY))
    roots = np.linalg.eigvals(gear.matrices(40.0, 150e3)[0])
    for expected in PUBLISHED:
        assert np.abs(roots - expected).min() < 1e-5 * abs(expected)
