"""
Which contacts stick, and which slide
=====================================

Two blocks lie on a slope of 25 degrees, whose tangent is 0.466. The rough block, with mu_v = 0.6,
stays. The smooth block, with mu_v = 0.3, slides. When it has risen to its boundary layer, it slides
by h^2 g (sin - mu_v cos) in each step, without acceleration, since each step starts from rest.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

slope, mu_v, gravity = np.radians(25), 0.3, 9.81
down = np.array([np.cos(slope), 0, -np.sin(slope)])
# In the scenario the blocks lie side by side; here the smooth one starts 250 mm farther down.
place = 0.05 * np.array([np.sin(slope), 0, np.cos(slope)]) + 0.25 * down - [0, 0.2, 0]
scenario = qr.load_scenario("block_incline", {"bodies.smooth.pose.xyz": place.tolist()}, steps=30)
run = scenario.run(progress=False)
formula = scenario.h**2 * gravity * (np.sin(slope) - mu_v * np.cos(slope))

# %%
# How far each block goes in a step, along the slope.
paths = {}
for block in ("rough", "smooth"):
    places = np.column_stack([scenario.system.of(run.q, f"{block}.{axis}") for axis in "xyz"])
    paths[block] = (places - places[0]) @ down
assert np.abs(paths["rough"]).max() < 1e-12
assert abs(np.diff(paths["smooth"])[-1] / formula - 1) < 1e-6

figure, (scene, curves) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
last = qr.figures.moment(scenario, run, -1)
qr.draw_scene(scene, last, view="xz")  # from the side
for block, side in (("rough", 1), ("smooth", -1)):
    (state,) = {contact.state for contact in last.contacts if side * contact.beta[1] > 0}
    curves.plot(np.append(0, run.t), 1e3 * paths[block], label=f"{block}: contacts are {state}")
curves.set(xlabel="time t [s]", ylabel="way down the slope [mm]")
curves.set_title(f"Smooth: {1e6 * formula:.1f} µm a step")
curves.legend()
plt.show()
