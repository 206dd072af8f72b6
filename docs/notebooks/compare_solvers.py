# ---
# jupyter:
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Compare solvers
#
# A solver's "optimal" is no evidence. The exact optimum of each step is known here, so the correct digits of every answer can be counted.

# %%
import matplotlib.pyplot as plt
import numpy as np

import quasistatic_ref as qr

run = qr.load_scenario("bunny_grasp", fast=True).run(progress=False)
steps = [run.step_data(k) for k in range(0, len(run.t), 15)]
SOLVERS = ("clarabel", "daqp", "osqp", "piqp")

# %%
digits = {}
for name in SOLVERS:
    each = [qr.solve_step(step, name).statistics.digits for step in steps]
    digits[name] = np.array(each, dtype=float)
    print(f"{name:9} median {np.median(digits[name]):4.1f}, least {digits[name].min():4.1f} digits")

# %%
figure, axes = plt.subplots(figsize=(5.5, 3), layout="constrained")
for name, mark in zip(SOLVERS, "os^v", strict=True):
    axes.plot(digits[name], mark, markersize=4, markerfacecolor="none", label=name)
axes.set(xlabel="every 15th step", ylabel="correct digits of the answer [-]", ylim=(0, 17))
axes.legend()
plt.show()

# %% [markdown]
# Whatever the solver, the answer that is returned has the same bits: its own answer is only a guess at which rows bear load.

# %%
answers = [qr.solve_step(steps[3], name).delta_q for name in SOLVERS]
print("the same bits from all:", all(np.array_equal(answers[0], each) for each in answers))

# %% [markdown]
# A solver of your own is a function of (P, q, G, h). This one projects dual variables, sweep by sweep (Hildreth's method).


# %%
def hildreth(P, q, G, h, sweeps=2000):
    """Minimise 1/2 x'Px + q'x subject to Gx <= h, by coordinate descent on the dual."""
    inverse = np.linalg.inv(P)
    dual, offset = G @ inverse @ G.T, h + G @ inverse @ q
    z = np.zeros(len(h))
    for _ in range(sweeps):
        for i in range(len(z)):
            z[i] = max(0.0, z[i] - (offset[i] + dual[i] @ z) / dual[i, i])
    return -inverse @ (q + G.T @ z), z, "optimal"


solution = qr.solve_step(steps[3], hildreth)
print(f"digits of Hildreth's method: {solution.statistics.digits:.1f}")
print("the same bits:", np.array_equal(solution.delta_q, answers[0]))
