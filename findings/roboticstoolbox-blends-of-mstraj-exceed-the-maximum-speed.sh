#!/usr/bin/env bash
# roboticstoolbox-python 1.4.4: mstraj from 0 to 10 and by way of other points, with qdmax=1 ("maximum speed"), for
# acceleration times of 0 to 0.5 s and steps of 1 to 10 ms.
# Expected: no speed above 1. What comes: 1 without blends; with blends a peak of up to 1.5 in the first or the last, which
# goes from rest, in the time that full speed takes for it, as far as full speed goes, and so has to be faster.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet roboticstoolbox-python==1.4.4 spatialmath-python==1.1.18 numpy==2.4.6

"$folder/venv/bin/python" -W ignore - << 'PYTHON'
import numpy as np
from roboticstoolbox import mstraj

LIMIT = 1.0
for way in ([0.0, 10.0], [0.0, 1.0, 2.0], [0.0, 3.0, 0.0]):
    for blend in (0.0, 0.1, 0.2, 0.5):
        for step in (0.01, 0.001):
            motion = mstraj(np.array(way)[:, None], dt=step, tacc=blend, qdmax=[LIMIT])
            speeds = np.abs(np.diff(np.ravel(motion.q))) / step
            print(f"by {way}, blends of {blend} s, steps of {step} s: top speed {speeds.max():.3f}, at {motion.t[speeds.argmax()]:.3f} s")
            assert np.isclose(np.ravel(motion.q)[-1], way[-1])
            if blend == 0:
                assert np.isclose(speeds.max(), LIMIT)
            else:
                assert 1.15 * LIMIT < speeds.max() < 1.6 * LIMIT
                assert not blend < motion.t[speeds.argmax()] < motion.t[-1] - blend
PYTHON
