"""
Which contacts stick, and which slide
=====================================

Two blocks on a slope of 25 degrees, whose tangent is 0.466. The rough one, with mu_v = 0.6, stays.
The smooth one, with mu_v = 0.3, slides. It first rises to its boundary layer. From then on it goes
h^2 g (sin - mu_v cos) in each step, without acceleration, since each step starts from rest.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

scenario = qr.load_scenario("block_incline", steps=30)
run = scenario.run(progress=False)
slope, mu_v, gravity = np.radians(25), 0.3, 9.81
formula = scenario.h**2 * gravity * (np.sin(slope) - mu_v * np.cos(slope))

# %%
# How far each block goes in a step, along the slope.
down = np.array([np.cos(slope), 0, -np.sin(slope)])
paths = {}
for block in ("rough", "smooth"):
    places = np.column_stack([scenario.system.of(run.q, f"{block}.{axis}") for axis in "xyz"])
    paths[block] = (places - places[0]) @ down
assert np.abs(paths["rough"]).max() < 1e-12
assert abs(np.diff(paths["smooth"])[-1] / formula - 1) < 1e-6

figure, (scene, states) = plt.subplots(1, 2, figsize=(8, 3.4), layout="constrained")
qr.draw_scene(scene, qr.figures.moment(scenario, run, -1), view="xy")  # from above
moments = [qr.figures.moment(scenario, run, k) for k in range(run.steps)]
shades = {"apart": 0.0, "sticking": 0.4, "sliding": 1.0}
shade = np.array([[shades[contact.state] for contact in moment.contacts] for moment in moments]).T
states.imshow(shade, aspect="auto", cmap="Greys", vmin=0, extent=(0, run.t[-1], len(shade), 0))
states.set(xlabel="time t [s]", ylabel="contacts: grey sticks, black slides", yticks=[])
figure.suptitle(f"the smooth block goes {1e6 * formula:.1f} um in each step")
plt.show()
