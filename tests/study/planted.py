"""Solvers that are broken on purpose, and the problems that they are given."""

import numpy as np

from quasistatic_ref.lab.scenes.slabs import slab_step
from quasistatic_ref.lab.study.families.made import Made

FAKES = '''
import ctypes, os, signal
import numpy as np

def honest(P, q, G, h):
    """An active-set method; digits to the last."""
    import quadprog

    x, _, _, _, z, _ = quadprog.solve_qp(P, -q, -G.T.copy(), -h)
    return x, z

def loops(P, q, G, h):
    while True:
        pass

def loops_in_c(P, q, G, h):
    ctypes.PyDLL(None).sleep(1000)  # holds the interpreter: no signal handler, no thread runs

def exits(P, q, G, h):
    os._exit(7)

def segfaults(P, q, G, h):
    os.kill(os.getpid(), signal.SIGSEGV)

def nan(P, q, G, h):
    return np.full(len(q), np.nan), np.zeros(len(h))

def nan_multipliers(P, q, G, h):
    return np.zeros(len(q)), np.full(len(h), np.nan)

def too_long(P, q, G, h):
    return np.zeros(len(q) + 1), np.zeros(len(h))

def no_pair(P, q, G, h):
    return 3.0

def no_numbers(P, q, G, h):
    return ["a"] * len(q), np.zeros(len(h))

def liar(P, q, G, h):
    return np.zeros(len(q)), np.zeros(len(h))

def raises(P, q, G, h):
    raise RuntimeError("no licence\\nfound")

def gives_up(P, q, G, h):
    return None

def prints(P, q, G, h):
    os.write(1, b"noise " * 10000)
    print("noise", flush=True)
    return honest(P, q, G, h)

def spoils(P, q, G, h):
    answer = honest(P, q, G, h)
    P[:], q[:], G[:], h[:] = 0, 0, 0, 0
    return answer
'''


def slab(seed=5, contacts=12, ratio=10.0, h=0.01):
    """One step of the scaled family, with its name."""
    step = slab_step(np.random.default_rng(seed), contacts, ratio, h)
    return Made(f"slab/{seed}", "slab", step, ratio, 0)
