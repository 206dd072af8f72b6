"""A store of no real run: rows at random, of every outcome, so that a report has all there is."""

import random

from quasistatic_ref.lab.study.store.rows import CLOCKS
from quasistatic_ref.lab.study.store.store import Store, contents

SOLVERS = ("qpsolvers:ant", "qpsolvers:bee", "qpsolvers:cat", "cvxpy:ant")
SETTINGS = {"default": (None, 3.0), "mid": (1e-6, 2.5), "high": (1e-9, 4.0)}
FAMILIES = ("stack", "door")
OUTCOMES = ("solved",) * 8 + ("failed", "crashed", "timeout", "nan", "wrong_shape")
LIMIT = 0.5


def measurement(chance, problem, solver, setting, units, warm, repetition=0):
    """One row; a budget ends for cat after problem 8."""
    interface, name = solver.split(":")
    late = name == "cat" and problem > 8
    outcome = "not_run_budget" if late else chance.choice(OUTCOMES)
    solved = outcome == "solved"
    answered = solved or outcome == "failed"
    digits = chance.uniform(0, 16) if answered else None
    call = 10 ** chance.uniform(-5, -1)
    own = {"call": call, "spent": 1.0, "solver": 0.5 * call if name != "bee" else None,
           "setup": 0.2 * call if name == "ant" else None, "first": 2 * call}  # fmt: skip
    return {
        "problem": f"{FAMILIES[problem % 2]}/{problem}/0",
        "family": FAMILIES[problem % 2],
        "solver": name,
        "interface": interface,
        "setting": setting,
        "mode": "",
        "warm": warm,
        "units": units,
        "repetition": repetition,
        "outcome": outcome,
        "claimed": "fine" if solved else "sorry",
        "feasible": True,
        "said_optimal": solved or outcome == "nan",
        "said_infeasible": outcome == "failed" and problem % 4 == 0,
        "wrong": outcome == "nan" or (solved and digits < SETTINGS[setting][1])
        or (outcome == "failed" and problem % 4 == 0),
        "wrong_multipliers": solved and digits * 0.8 < SETTINGS[setting][1],
        "digits": {"delta_q": digits, "net_wrench": digits and digits * 0.9,
                   "multipliers": digits and digits * 0.8},
        "residuals": {"primal": 1.23456e-9, "dual": None, "gap": 0.0},
        "allowed": dict.fromkeys(("primal", "dual", "gap")),  # of digits that were promised
        "seconds": dict.fromkeys(CLOCKS) | own,
        "calls": 5,
        "clock_agrees": chance.random() < 0.99,
        "memory": int(1e8 * chance.random()),
        "iterations": chance.choice([None, 7, 12]),
        "repeats": False if solved else None,
    }  # fmt: skip


def write_store(folder, count=12, seed=3, **changes):
    """Write the store; returns its rows."""
    chance = random.Random(seed)
    rows = []
    for problem in range(count):
        for solver in SOLVERS:
            for setting in SETTINGS:
                for units in ("raw", "natural"):
                    for warm in (False, True):
                        # Warm starts are made on a part of the problems only.
                        if not warm or problem % 3 == 0:
                            one = (problem, solver, setting, units, warm)
                            rows.append(measurement(chance, *one))
                            if problem % 5 == 0:  # run again, for the noise
                                rows.append(measurement(chance, *one, repetition=1))
    folder.mkdir()
    with Store(folder, STUDY | changes, facts(count)) as store:
        store.add(*rows)
    return rows


def of_another_machine(folder, out):
    """A store of the same measurements, each of which took twice as long; returns its folder."""
    found = contents(folder)
    out.mkdir()
    with Store(out, found.study, found.problems) as store:
        for row in found.rows:
            times = {n: v and 2 * v for n, v in row["seconds"].items()}
            store.add(row | {"seconds": times})
    return out


STUDY = {
    "kind": "solvers",
    "time_limit": LIMIT,
    "settings": [
        {"name": name, "accuracy": accuracy, "promised": promised, "tuned": False}
        for name, (accuracy, promised) in SETTINGS.items()
    ],
    "solvers": [
        {
            "name": s.split(":")[1],
            "interface": s.split(":")[0],
            "target": s.split(":")[1],
            "options": {name: {"eps": accuracy or 0.0} for name, (accuracy, _) in SETTINGS.items()},
            "promise": {name: {"digits": digits} for name, (_, digits) in SETTINGS.items()},
        }
        for s in SOLVERS
    ],
    "machine": {"processor": "slide rule"},
    "versions": {"ant": "1.0"},
}


def facts(problems):
    """Of so many problems; of those with more than 30 rows seven digits are known."""
    return [
        {"id": f"{FAMILIES[p % 2]}/{p}/0", "family": FAMILIES[p % 2], "contacts": p + 1, "h": 0.01,
         "mass_ratio": 1.0, "k": 1, "n": 6, "m": 4 * p + 4, "condition": 10.0 * p + 1,
         "condition_natural": 1.5, "kind": "exact" if p <= 6 else "enclosed",
         "bound": 0.0 if p <= 6 else 1e-7, "sequence": None, "place": None}
        for p in range(problems)
    ]  # fmt: skip


SWEEP = """run,mu,cone,outcome,reason,block.largest_rotation_deg,boundary_layer_um,steps_taken
runs/a.npz,0.0,pyramid,done,,0.25,20.0,2.0
runs/b.npz,0.3,pyramid,done,,3.25,20.0,2.0
runs/c.npz,0.1,pyramid,done,,1.25,20.0,2.0
runs/d.npz,0.1,product,ended_early,it fell,,,1.0
runs/e.npz,0.0,product,done,,0.125,10.0,2.0
"""
"""The table of a sweep, one of whose runs ended early."""
