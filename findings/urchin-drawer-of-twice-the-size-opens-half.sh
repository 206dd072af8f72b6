#!/usr/bin/env bash
# urchin 0.0.30: URDF.copy(scale=...) of a cupboard of 3 kg with a drawer of 2 kg on a slider, at scale 1, 2 and 10, and a copy
# without a scale.
# Expected: lengths times s, and so the limits of the slider, which are lengths; masses times s^3 and inertias times s^5 at one
# density, and all as in the file at scale 1. What comes: limits as before, so that the drawer of twice the size opens half; the
# centre and the moments of mass in the file are replaced, also at scale 1, by those of the collision shape full of the same stuff,
# so that a hollow cupboard is easier to turn by up to two fifths. Without a scale all is kept.
set -euo pipefail
folder="$(mktemp -d)"
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet numpy==2.4.6 trimesh==5.2.0 lxml==6.1.3 networkx==3.6.1 pillow==13.0.0
# Without what draws.
"$folder/venv/bin/python" -m pip install --quiet --no-deps urchin==0.0.30
cd "$folder"

cat > cupboard.urdf << 'URDF'
<robot name="cupboard">
  <link name="case"><inertial><origin xyz="0 0 0.05" rpy="0 0 0"/><mass value="3"/>
    <inertia ixx="0.22" iyy="0.19" izz="0.09" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0" rpy="0 0 0"/><geometry><box size="0.3 0.4 0.6"/></geometry></collision></link>
  <link name="drawer"><inertial><origin xyz="0 0 0" rpy="0 0 0"/><mass value="2"/>
    <inertia ixx="0.04" iyy="0.03" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0 0 0" rpy="0 0 0"/><geometry><box size="0.3 0.4 0.2"/></geometry></collision></link>
  <joint name="slider" type="prismatic"><parent link="case"/><child link="drawer"/><origin xyz="0 0 0.2" rpy="0 0 0"/>
    <axis xyz="0 1 0"/><limit lower="0" upper="0.4" effort="50" velocity="1"/></joint>
</robot>
URDF

venv/bin/python - << 'PYTHON'
import numpy as np
import urchin

SIZES = {"case": np.array([0.3, 0.4, 0.6]), "drawer": np.array([0.3, 0.4, 0.2])}
given = urchin.URDF.load("cupboard.urdf")


def solid(name):
    """Moments of inertia of the collision box with the mass in the file."""
    squares = SIZES[name] ** 2
    return given.link_map[name].inertial.mass / 12 * (squares.sum() - squares)


for scale in (None, 1.0, 2.0, 10.0):
    copy = given.copy() if scale is None else given.copy(scale=scale)
    factor = scale or 1.0
    slider = copy.joint_map["slider"]
    print(f"scale {scale}: slider from {slider.limit.lower} to {slider.limit.upper}, due {factor * 0.4:g}")
    assert slider.limit.upper == given.joint_map["slider"].limit.upper
    assert np.allclose(slider.origin[:3, 3], [0, 0, 0.2 * factor])
    for name, size in SIZES.items():
        link = copy.link_map[name]
        inertia = np.diag(link.inertial.inertia)
        due = factor**5 * np.diag(given.link_map[name].inertial.inertia)
        print(f"  {name} of {link.inertial.mass:.4g} kg: {inertia.round(4)} kg m^2, due {due.round(4)}")
        assert np.allclose(link.collisions[0].geometry.box.size, factor * size)
        assert np.isclose(link.inertial.mass, factor**3 * given.link_map[name].inertial.mass)
        if scale is None:
            assert np.allclose(inertia, due)
            assert np.allclose(link.inertial.origin, given.link_map[name].inertial.origin)
        else:
            assert np.allclose(inertia, factor**5 * solid(name), rtol=1e-6)
            assert np.allclose(link.inertial.origin[:3, 3], 0.0, atol=1e-6 * factor)
            assert np.all(inertia < 0.95 * due)
PYTHON
