#!/usr/bin/env bash
# pinocchio 4.1.0 with its URDF reader urdfdom: a link whose collision shape is a capsule, in files that say version 1.0, 1.1,
# 1.2, or nothing; and one whose radius is written with a comma.
# Expected: the shape, or an error. What comes without a version, with 1.0 and with the comma: a model without a shape, and
# words on standard error alone. Such a robot passes through everything.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet pin==4.1.0 numpy==2.4.6

"$folder/venv/bin/python" - << 'PYTHON'
import pinocchio as pin


def shapes(version, shape):
    text = (
        f'<robot name="r"{version}><link name="base"/><link name="tip"><inertial><mass value="1"/>'
        '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
        f'<collision><geometry>{shape}</geometry></collision></link>'
        '<joint name="j" type="continuous"><parent link="base"/><child link="tip"/>'
        '<axis xyz="0 0 1"/></joint></robot>'
    )
    model = pin.buildModelFromXML(text)
    return pin.buildGeomFromUrdfString(model, text, pin.GeometryType.COLLISION).ngeoms


capsule = '<capsule radius="0.1" length="0.5"/>'
counts = {}
for version in ("", ' version="1.0"', ' version="1.1"', ' version="1.2"'):
    counts[version] = shapes(version, capsule)
    print(f"capsule, <robot{version}>: {counts[version]} shapes")
comma = shapes("", '<sphere radius="0,1"/>')
print(f"sphere of radius 0,1: {comma} shapes")
assert list(counts.values()) == [0, 0, 1, 1]
assert comma == 0
PYTHON
