"""A point on a floor, pulled by 0.8 of its weight, mu = 0.5: slip and rise of the 50th step of 10 ms."""

import numpy as np

from quasistatic_ref import solve_step
from quasistatic_ref.lab.scenes.rigid import point_step

for x, y in (1.0, 0.0), (0.5**0.5, 0.5**0.5):
    force, slip, gap = 0.3 * 9.81 * np.array([0.8 * x, 0.8 * y, -1]), np.zeros(3), 0.0
    for _ in range(50):  # the gap that a step leaves is that of the next
        slip = solve_step(point_step(0.3, force, 0.5, gap, 0.01)).delta_q
        gap += slip[2]
    way = np.hypot(*slip[:2])
    print(f"along ({x:.2f}, {y:.2f}): {way / (0.01**2 * 9.81):.3f} g (Coulomb: 0.300), rise {gap / way:.3f} (0)")
