"""A can of 216 points, written as can.npy."""

import numpy as np

angle, height = np.meshgrid(np.arange(24) * 2 * np.pi / 24, np.arange(-4, 5) * 0.01)
ring = [0.03 * np.cos(angle), 0.03 * np.sin(angle), height]  # m, from the centre of mass
np.save("can.npy", np.stack(ring, axis=-1).reshape(-1, 3))
