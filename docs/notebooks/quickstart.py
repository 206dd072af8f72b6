# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Quickstart
#
# A gripper closes on a bunny of 992 points and lifts it, after Figure 1 of Tracy and Manchester. This notebook runs the grasp with and without torsional friction, draws it, and checks one of its steps without a solver.

# %%
import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

scenario = qr.load_scenario("bunny_grasp", fast=True)
run = scenario.run(progress=False)
without = qr.load_scenario("bunny_grasp", {"contacts.grip.mu_omega": 0}, fast=True)
turning = without.run(progress=False)

# %% [markdown]
# The end of both runs, with one scale for all forces: arrows are the forces of the fingers on the bunny.

# %%
page, both = plt.subplots(1, 2, figsize=(8, 3.6), layout="constrained")
qr.draw_scenes(
    both, [qr.figures.moment(scenario, run, -1), qr.figures.moment(without, turning, -1)]
)
for axes, title in zip(both, ("with torsional friction", "without"), strict=True):
    axes.set_title(title)
plt.show()

# %% [markdown]
# How far the bunny turned as the hand sees it, from the closed grip to the end:

# %%
for name, scene, each in (("with", scenario, run), ("without", without, turning)):
    turn = np.degrees(qr.relative_turn(scene.system, each, "bunny", "gripper", since=0.7))
    print(f"{name} torsional friction: {turn[-1]:.2f} degrees")

# %% [markdown]
# Each step is one quadratic program. Its answer is the exact optimum, correctly rounded; its certificate is checked in rational numbers, without a solver.

# %%
step = run.step_data(150)
solution = qr.solve_step(step, "clarabel")
print(solution.certificate.kind, "with", len(solution.certificate.active), "active rows")
print(f"correct digits of Clarabel itself: {solution.statistics.digits:.1f}")
qr.verify(solution)
