#!/usr/bin/env bash
# roboticstoolbox-python 1.4.4: quintic, trapezoidal and jtraj from 0 to 1, for 2 s, over times that begin at 0, 0.5, 1 and 10 s.
# Expected: the same motion, begun later: from 0, at rest, with the same top speed.
# What comes: only times from 0 give that. From 1 s the motion begins at a fifth or a quarter of the way at about half a
# unit per second, from 10 s at 0.94 or more: time is counted from 0, so a robot at rest at 0 is commanded a jump.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet roboticstoolbox-python==1.4.4 spatialmath-python==1.1.18 numpy==2.4.6

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from roboticstoolbox import jtraj, quintic, trapezoidal

DURATION = 2.0
makers = {
    "quintic": lambda t: quintic(0, 1, t),
    "trapezoidal": lambda t: trapezoidal(0, 1, t),
    "jtraj": lambda t: jtraj([0.0], [1.0], t),
}
for name, make in makers.items():
    starts = {}
    for begin in (0.0, 0.5, 1.0, 10.0):
        times = begin + np.linspace(0, DURATION, 401)
        motion = make(times)
        q, speed = np.ravel(motion.q), np.ravel(motion.qd)
        starts[begin] = q[0], speed[0]
        print(f"{name:11} from {begin:4} s: begins at {q[0]:.4f} with {speed[0]:.4f} per second, ends at {q[-1]:.4f}")
        assert np.isclose(q[-1], 1.0)
        assert np.allclose(np.gradient(q, times), speed, atol=0.02)
    assert np.allclose(starts[0.0], 0.0, atol=1e-9)
    assert starts[0.5][0] > 0.05
    assert 0.2 < starts[1.0][0] < 0.26
    assert 0.48 < starts[1.0][1] < 0.52
    assert starts[10.0][0] > 0.9
PYTHON
