"""
The force of a finger that wipes
================================

A spring presses a finger with K_q e = 5 N, and the finger wipes over a table at 50 mm/s. In this
model a finger that slides rises by mu_v h v against its spring, so N = K_q (e + mu_v h v), (R13).
By Coulomb's law the finger does not rise, and N = K_q e at every h.
"""

import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

mu_v, v, K_q, e = 0.5, 0.05, 20e3, 0.25e-3
time_steps = np.array([0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3, 100e-3])
axes = {"x": "1 0 0", "z": "0 0 1"}
links = "".join(f'<link name="{name}"/>' for name in ("post", "slide"))
joints = "".join(
    f'<joint name="{name}" type="prismatic"><parent link="{parent}"/><child link="{child}"/>'
    f'<axis xyz="{axes[name]}"/><limit lower="-1" upper="1" effort="100" velocity="1"/></joint>'
    for name, parent, child in (("x", "post", "slide"), ("z", "slide", "tip"))
)
tip = '<link name="tip"><collision><geometry><sphere radius="0.01"/></geometry></collision></link>'


def force(h, law):
    """The normal force of the finger [N] once it slides steadily."""
    path = [{"t": 0.0, "x": 0.0, "z": -e}, {"t": 2.0, "x": 2 * v, "z": -e}]
    scenario = qr.load_scenario({
        "h": float(h), "steps": 20, "law": law,
        "bodies": {"finger": {
            "urdf": f'<robot name="finger">{links}{tip}{joints}</robot>', "actuated": "all",
            "K_q": {"x": K_q, "z": K_q}, "pose": {"xyz": [0, 0, 0.01]}, "targets": path,
        }},
        "shapes": {"table": {"halfspace": {"normal": [0, 0, 1], "offset": 0}}},
        "contacts": {"wipe": {"alpha": "table", "beta": "finger/tip", "mu_v": mu_v, "rows": 4}},
    })  # fmt: skip
    return scenario.run(progress=False)["wrench"][-1, 0, 2]


# %%
# Twenty steps are enough: the finger sticks until its target is mu_v N / K_q ahead.
convex, coulomb = (np.array([force(h, law) for h in time_steps]) for law in ("convex", "coulomb"))
formula = K_q * (e + mu_v * time_steps * v)
assert np.abs(convex / formula - 1).max() < 1e-3
assert np.abs(coulomb / (K_q * e) - 1).max() < 1e-3

figure, ax = plt.subplots(figsize=(4.8, 3.2), layout="constrained")
ax.semilogx(1e3 * time_steps, formula, color="0.6", linewidth=3, label=r"$K_q (e + \mu_v h v)$")
ax.semilogx(1e3 * time_steps, convex, "ko", label="the convex model")
ax.semilogx(1e3 * time_steps, coulomb, "k^", markerfacecolor="none", label="Coulomb's law")
ax.axvline(1e3 * e / (10 * mu_v * v), color="black", linestyle=":", label="a tenth more")
ax.set(xlabel="time step h [ms]", ylabel="normal force [N]", ylim=(0, 60))
ax.set_title(f"A larger step presses with more than {K_q * e:g} N")
ax.legend()
plt.show()
