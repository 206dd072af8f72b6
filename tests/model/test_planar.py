"""A planar base: x, y and the angle, by the twist of its own frame."""

from pathlib import Path

import numpy as np

from quasistatic_ref.model.system import Body, System
from tests.model.urdf.urdf_texts import BOX, written
from tests.tolerances import EXACT, ROUNDING


def slider(folder: Path) -> System:
    path = written(folder, BOX, "box.urdf")
    return System([Body("box", path, "planar", xyz=(0.5, 0.6, 0.7), rpy=(0, 0, 0.3))])


def test_a_planar_base_has_three_coordinates_and_starts_where_it_was_put(tmp_path: Path) -> None:
    system = slider(tmp_path)
    assert [(c.name, c.unit) for c in system.coordinates] == [
        ("box/base.x", "m"),
        ("box/base.y", "m"),
        ("box/base.rz", "rad"),
    ]
    pose = system.kinematics(system.q_start)
    np.testing.assert_allclose(pose.t[1], [0.5, 0.6, 0.7], rtol=EXACT, atol=ROUNDING)
    np.testing.assert_allclose(pose.R[1][0, 0], np.cos(0.3), rtol=EXACT, atol=ROUNDING)


def test_a_planar_base_moves_along_its_own_axes(tmp_path: Path) -> None:
    system = slider(tmp_path)
    q = system.integrate(system.q_start, np.array([0.1, 0.0, 0.0]))
    expected = [0.5 + 0.1 * np.cos(0.3), 0.6 + 0.1 * np.sin(0.3), 0.7]
    np.testing.assert_allclose(system.kinematics(q).t[1], expected, rtol=EXACT, atol=ROUNDING)
    # A quarter turn at radius r: the arc from (0, 0), heading x, ends at (r, r).
    q = system.integrate(system.neutral(), np.array([np.pi / 2, 0.0, np.pi / 2]))
    np.testing.assert_allclose(q[:2], [1, 1], rtol=EXACT, atol=ROUNDING)
    back = system.difference(system.neutral(), q)
    np.testing.assert_allclose(back, [np.pi / 2, 0, np.pi / 2], rtol=EXACT, atol=ROUNDING)


def test_the_mass_matrix_of_a_planar_base_is_that_of_a_plate(tmp_path: Path) -> None:
    # m = 1.5, c = (0.01, -0.02): [[m, 0, -m cy], [0, m, m cx], [., ., izz + m |c|^2]].
    m, (x, y), izz = 1.5, (0.01, -0.02), 0.04
    expected = [[m, 0, -m * y], [0, m, m * x], [-m * y, m * x, izz + m * (x * x + y * y)]]
    system = slider(tmp_path)
    np.testing.assert_allclose(system.M_u(system.q_start), expected, rtol=EXACT, atol=ROUNDING)
