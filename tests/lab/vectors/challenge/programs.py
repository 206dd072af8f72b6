"""Programs that are challenged: each a few lines of Python, that answer well or not."""

import shlex
import sys

ANSWERS = """
import json, math, sys
def right(case):  # the layer selection
    given, found = case["input"], []
    for g, phi in enumerate(given["phi"]):
        left = list(range(len(phi)))
        if "normals" in given:
            n = given["normals"][g]
            left = [i for i in left if sum(map(float.__mul__, n[i], n[-1])) >= math.cos(0.25)]
        order = sorted(left, key=lambda i: (phi[i], i))
        found.append([*order, *range(len(phi), 2 * len(phi) - len(left))][:given["k"]])
    return {"indices": found}
def say(id, **what):
    print(json.dumps({"id": id, **what}), flush=True)
cases = map(json.loads, sys.stdin)
"""

PROGRAMS = {
    "right": "for case in cases: say(case['id'], output=right(case))",
    "declares a layer": """
print(json.dumps({"protocol": 1, "implementation": "mine 3", "layers": ["selection"]}), flush=True)
for case in cases:
    if case["layer"] != "selection": say(case["id"], error="what is that?")
    else: say(case["id"], output=right(case))
""",
    "wrong": "for case in cases: say(case['id'], output={'indices': [[0]]})",
    "ends": """
for number, case in enumerate(cases):
    if number % 4 == 3: raise SystemExit(3)
    say(case["id"], output=right(case))
""",
    "is killed": """
import os, signal
for number, case in enumerate(cases):
    if number % 4 == 3: os.kill(os.getpid(), signal.SIGSEGV)
    say(case["id"], output=right(case))
""",
    "hangs": """
import subprocess, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(60)"])
for number, case in enumerate(cases):
    if number == 3: time.sleep(100)
    say(case["id"], output=right(case))
""",
    "prints garbage": """
for number, case in enumerate(cases):
    if number % 3 == 2: print("NaN detected, resetting", flush=True)
    say(case["id"], output=right(case))
""",
    "prints what is no text": """
for number, case in enumerate(cases):
    if number == 2: sys.stdout.buffer.write(bytes(range(128, 200)) + b"[" * 5000 + b"\\n")
    sys.stdout.flush()
    say(case["id"], output=right(case))
""",
    "prints a line without end": """
sys.stdout.write("x" * (2**26 + 9))
sys.stdout.flush()
import time; time.sleep(60)
""",
    "closes its output": """
import os, time
for number, case in enumerate(cases):
    if number == 3: os.close(1); time.sleep(100)
    say(case["id"], output=right(case))
""",
    "answers twice": """
for case in cases:
    say(case["id"], output=right(case))
    say(case["id"], output=right(case))
""",
    "does not read": """
import time
time.sleep(100)
""",
    "refuses": "for case in cases: say(case['id'], error='not today')",
    "supports nothing": "for case in cases: say(case['id'], unsupported=True)",
    "answers neither": "for case in cases: say(case['id'], answer=right(case))",
    "declares nonsense": """
print(json.dumps({"protocol": 1, "tangent": "sideways"}), flush=True)
for case in cases: say(case["id"], output=right(case))
""",
    "ends at once": "raise SystemExit(3)",
}


def command(name, folder):
    """The command of one of them."""
    path = folder / "program.py"
    path.write_text(ANSWERS + PROGRAMS[name])
    return shlex.join([sys.executable, str(path)])
