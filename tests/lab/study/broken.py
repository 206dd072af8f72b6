"""Solvers of tests: some honest, most broken on purpose."""

import os
import subprocess
import time

import numpy as np


def honest(P, q, G, h):
    """An active-set method; digits to the last."""
    import quadprog

    x, _, _, _, z, _ = quadprog.solve_qp(P, -q, -G.T.copy(), -h)
    return x, z, "optimal"


def zeros(P, q, G, h):
    """No digit."""
    return np.zeros(len(q)), np.zeros(len(h)), "optimal"


def too_long(P, q, G, h):
    """One number too many."""
    return np.zeros(len(q) + 1), np.zeros(len(h)), "optimal"


def no_numbers(P, q, G, h):
    """Words."""
    return ["a"] * len(q), np.zeros(len(h)), "optimal"


def pair(P, q, G, h):
    """No status."""
    return np.zeros(len(q)), np.zeros(len(h))


def nan(P, q, G, h):
    """Not a number."""
    return np.full(len(q), np.nan), np.zeros(len(h)), "optimal"


def gives_up(P, q, G, h):
    """Nothing."""
    return None, None, "too many sweeps"


def denies(P, q, G, h):
    """The solution."""
    return None, None, "infeasible"


def raises(P, q, G, h):
    """An error of two lines."""
    raise RuntimeError("no licence\nat all")


def exits(P, q, G, h):
    """Its process ends."""
    os._exit(7)


def sleeps(P, q, G, h):
    """So does a program that it starts, whose id it writes down."""
    child = subprocess.Popen(["sleep", "600"])
    with open(os.environ["CHILD"], "w") as file:
        file.write(str(child.pid))
    time.sleep(600)


def eats(P, q, G, h):
    """400 MB."""
    held = np.ones(5 * 10**7)
    time.sleep(600)
    return held


def spoils(P, q, G, h):
    """Prints, and writes into what it was given."""
    os.write(1, b"noise")
    answer = honest(P, q, G, h)
    P[:], q[:], G[:], h[:] = 0, 0, 0, 0
    return answer
