#!/usr/bin/env bash
# Klampt 0.10.1.post1: force_closure of frictionless contacts on a disc (3, 4, 6) and on a ball (6, and 12 at random places).
# Expected: no, since every normal goes through the centre and no contact turns the disc or the ball about it; the wrenches
# span two or three of six dimensions. What comes: yes for all of them, as for the same six contacts with friction 0.3.
# Contacts on one side only are told apart, so the answer is not yes always.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet klampt==0.10.1.post1 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import numpy as np
from klampt.robotsim import force_closure


def contacts(points, friction):
    """On the unit ball, with normals towards its centre."""
    return [[*point, *(-np.array(point)), friction] for point in points]


def wrenches(points):
    """Dimension of what frictionless contacts can exert."""
    return np.linalg.matrix_rank([[*-point, *np.cross(point, -point)] for point in points])


random = np.random.default_rng(0).normal(size=(12, 3))
places = {
    f"disc, {n} contacts": [np.array([np.cos(a), np.sin(a), 0.0]) for a in 2 * np.pi * np.arange(n) / n] for n in (3, 4, 6)
}
places["ball, 6 contacts"] = [sign * axis for axis in np.eye(3) for sign in (1, -1)]
places["ball, 12 contacts"] = list(random / np.linalg.norm(random, axis=1)[:, None])
for name, points in places.items():
    answer = force_closure(contacts(points, 0.0))
    print(f"{name} without friction: {answer}, though they span {wrenches(points)} of 6 dimensions")
    assert wrenches(points) < 4
    assert answer
assert force_closure(contacts(places["ball, 6 contacts"], 0.3))
side = [np.array([np.cos(a), np.sin(a), 0.0]) for a in (-0.3, 0.0, 0.3)]
for friction in (0.001, 0.5):
    assert not force_closure(contacts(side, friction))
PYTHON
