#!/usr/bin/env bash
# bvhio 1.5.4: a leg in BVH, a hip, a knee 40 cm below it and an end site, the tip of the foot, 25 cm ahead of it and 5 cm below,
# read as a hierarchy and written again, without and with a tip that the file turns forwards; beside the bvh package 0.3.
# Expected: the file that was read, up to rounding, or an error. What comes: the same channels and frames, and an end site straight
# on from the shin with 0.3 of its length, wherever it was: the tip of the foot has moved by 26 cm. readAsBvh and writeBvh keep it,
# convertBvhToHierarchy drops it, and the documentation shows the way there and back.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet bvhio==1.5.4 spatial-transform==1.3.3 PyGLM==2.8.2 bvh==0.3 numpy==2.4.6
cd "$folder"

venv/bin/python - << 'PYTHON'
import bvh
import bvhio
import numpy as np

FRAMES = "0 90 0 0 0 0 0 0 0\n1 91 2 10 20 30 -40 5 0\n"
SHIN = np.array([0.0, -40.0, 0.0])


def leg(tip):
    """A hip with one shin, whose end site is at tip, in centimetres."""
    return (
        "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation\n"
        "JOINT knee\n{\nOFFSET " + " ".join(map(str, SHIN)) + "\nCHANNELS 3 Zrotation Xrotation Yrotation\nEnd Site\n{\n"
        f"OFFSET {' '.join(map(str, tip))}\n}}\n}}\n}}\nMOTION\nFrames: 2\nFrame Time: 0.01\n{FRAMES}"
    )


def end_site(path):
    """The offset of the end site, and the frames, as the other package reads them."""
    with open(path, encoding="ascii") as file:
        motion = bvh.Bvh(file.read())
    knee = motion.get_joint("knee")
    return np.array([float(number) for number in knee.children[-1]["OFFSET"]]), np.array(motion.frames, float)


for tip in (np.array([0.0, -5.0, 25.0]), np.array([3.0, -20.0, 0.0]), np.array([0.0, 0.0, 18.0])):
    with open("leg.bvh", "w", encoding="ascii") as file:
        file.write(leg(tip))
    given, frames = end_site("leg.bvh")
    bvhio.writeHierarchy("again.bvh", bvhio.readAsHierarchy("leg.bvh"), 0.01)
    written, frames_written = end_site("again.bvh")
    bvhio.writeBvh("plain.bvh", bvhio.readAsBvh("leg.bvh"))
    plain, _ = end_site("plain.bvh")
    away = np.linalg.norm(written - tip)
    print(f"end site {given} cm: by way of the hierarchy {written.round(3)} cm, {away:.1f} cm away; without it {plain}")
    assert np.allclose(given, tip)
    assert np.allclose(plain, tip)
    assert np.allclose(frames_written, frames, atol=1e-3)
    assert np.allclose(written, 0.3 * SHIN, atol=1e-4)
    assert away > 8
PYTHON
