#!/usr/bin/env bash
# ProxQP of proxsuite 0.8.0: a body on a spring of 100 N/m is pulled by 1 N along each axis, in a slot along that diagonal that it does not touch.
# It rests where the spring bears the force, 10 mm along each axis, whatever unit of length the program is written in.
# Expected: that. What comes: solved in metres and millimetres; in micrometres "dual infeasible", no least energy, after 0.1 mm.
# Without the slot, which is not active, it is solved in micrometres, too. The tolerance of such a proof, eps_dual_inf, is 1e-4;
# in micrometres it is as large as the stiffness, 1e-4 N/um.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet proxsuite==0.8.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
import proxsuite

FORCE = np.array([1.0, 1.0])  # N
ACROSS = np.array([[1.0, -1.0]])  # the slot: |x - y| is at most 1 um


def rest(unit, *, slot):
    """Where the body rests [mm], by ProxQP with its own options, with lengths in `unit` [m]."""
    rows = ACROSS if slot else ACROSS[:0]
    half_width = np.full(len(rows), 1e-6 / unit)
    program = proxsuite.proxqp.dense.QP(2, 0, len(rows))
    program.init(100.0 * unit * np.eye(2), -FORCE, None, None, rows, -half_width, half_width)
    program.solve()
    status = program.results.info.status.name
    x = program.results.x * unit * 1e3
    print(f"unit {unit:g} m, slot {slot}: {status}, {x.round(3)} mm")
    return status, x


for unit in 1.0, 1e-3:
    status, x = rest(unit, slot=True)
    assert status == "PROXQP_SOLVED"
    assert np.allclose(x, 10.0, rtol=1e-3)
status, x = rest(1e-6, slot=False)
assert status == "PROXQP_SOLVED"
assert np.allclose(x, 10.0, rtol=1e-3)
status, x = rest(1e-6, slot=True)
assert status == "PROXQP_DUAL_INFEASIBLE"
assert np.all(np.abs(x) < 1.0)
PYTHON
