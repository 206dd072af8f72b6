"""
A spun sphere lifts off
=======================

A sphere on the floor is spun by a torque that grows, after Figure 3 of the paper.

Up to a torque of mu_omega m g the sphere does not move at all. A larger torque turns the sphere,
and the sphere hovers: Eq. (7) asks for a gap of mu_omega theta if a step turns the sphere by
theta. This boundary layer is the price of a convex step. At the end the torque is five times the
limit, and with h = 20 ms the sphere hovers 5.86 mm above the floor. With h = 10 ms the gap is a
quarter of that, because the angle by which a torque turns the sphere in a step grows with h
squared.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

scenario = qr.load_scenario("sphere_spin", {"steps": 100, "h": 0.02})
run = scenario.run(progress=False)
(wrench,) = scenario.wrenches
torque = np.interp(run.t, wrench.times, wrench.values[:, 5])

# %%
# The scene's own numbers: mass, radius and mu_omega.
m, radius, mu_omega, gravity = 0.3, 0.05, 0.01, 9.81
limit = mu_omega * m * gravity
lift = run.q[1:, 2] - radius
turn = run.delta_q[:, 5]
assert np.abs(run.delta_q[torque < 0.999 * limit]).max() < 1e-12
assert np.abs(lift - mu_omega * turn).max() < 1e-12

figure, axes = plt.subplots(figsize=(4.8, 3.2), layout="constrained")
formula = 1e3 * mu_omega * turn
axes.plot(torque / limit, formula, color="0.6", linewidth=3, label=r"$\mu_\omega \theta$")
axes.plot(torque / limit, 1e3 * lift, "k.", markersize=4, label="lift of the sphere")
axes.set(xlabel=r"torque / ($\mu_\omega m g$) [-]", ylabel="height above the floor [mm]")
axes.set_title("Beyond the limit the sphere hovers")
axes.legend()
plt.show()
