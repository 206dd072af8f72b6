"""A program in C as a solver of a study.

First: cc -O2 -o hildreth hildreth.c -lm
"""

import json
import subprocess

program = subprocess.Popen(["./hildreth"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def solve(P, q, G, h):
    """Hand a problem to the program, as a line of JSON, and read its answer."""
    problem = {"H": P.tolist(), "g": (-q).tolist(), "A": (-G).tolist(), "b": (-h).tolist()}
    print(json.dumps(problem), file=program.stdin, flush=True)
    answer = json.loads(program.stdout.readline())
    return answer["delta_q"], answer["lam"], answer["status"]
