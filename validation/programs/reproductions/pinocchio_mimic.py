"""The first row of M of three hinges and one that mimics the first, by crba called three times: two hinges hang from the mimic joint's link."""

import numpy as np
import pinocchio as pin

INERTIAL = '<inertial><origin xyz="0.1 0 0"/><mass value="1"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/></inertial>'
links = "".join(f'<link name="{name}">{INERTIAL}</link>' for name in "0abcd")
more = {"b": '<mimic joint="a" multiplier="1"/>'}
tree = [("0", "a"), ("a", "b"), ("b", "c"), ("b", "d")]
joints = [f'<joint name="{b}" type="revolute"><parent link="{a}"/><child link="{b}"/><axis xyz="0 0 1"/><limit effort="1" velocity="1"/>{more.get(b, "")}</joint>' for a, b in tree]
text = f'<robot name="r">{links}{"".join(joints)}</robot>'
data = (model := pin.buildModelFromXML(text, mimic=True)).createData()
rows = [pin.crba(model, data, np.zeros(3))[0].round(6).tolist() for _ in range(3)]
free, G = pin.buildModelFromXML(text), np.array([[1, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])  # no joint mimics another
M = G.T @ pin.crba(free, free.createData(), np.zeros(4)) @ G
print(f"pinocchio {pin.__version__}: {rows[0]}, {rows[1]}, {rows[2]}; it is {M[0].round(6).tolist()}")
