"""A program in C as a solver of a study.

First: cc -O2 -o hildreth hildreth.c -lm
"""

import json
import subprocess
from functools import cache
from subprocess import PIPE


@cache
def started():
    """The program, started once, in the process of the solver."""
    return subprocess.Popen(["./hildreth"], stdin=PIPE, stdout=PIPE, text=True)


def solve(P, q, G, h):
    """Hand a problem to the program, as a line of JSON, and read its answer."""
    problem = {"H": P.tolist(), "g": (-q).tolist(), "A": (-G).tolist(), "b": (-h).tolist()}
    program = started()
    print(json.dumps(problem), file=program.stdin, flush=True)
    answer = json.loads(program.stdout.readline())
    return answer["delta_q"], answer["lam"], answer["status"]
