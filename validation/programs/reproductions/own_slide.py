"""A sled on four feet on a slope of tangent 1, mu = 0.5, by each cone: at which slope friction would hold it, its rise over the slip of a step."""

import numpy as np

import quasistatic_ref as qr

urdf = """<robot name="sled"><link name="sled"><inertial><mass value="0.3"/><inertia ixx="1e-3" iyy="1e-3" izz="2e-3" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""
system = qr.System([qr.Body("sled", urdf, "floating", xyz=(0, 0, 0.02))])
floor = qr.PlacedShape.in_world("floor", qr.HalfSpace((0, 0, 1), 0.0))
feet = [qr.PlacedShape(f"{x} {y}", system.link("sled"), np.eye(3), np.array([x, y, -0.01]), qr.Sphere(0.01)) for x in (-0.1, 0.1) for y in (-0.1, 0.1)]
pairs = [qr.ContactPair(foot.name, floor, foot, 0.5, 0.01, 6, 1) for foot in feet]
for cone, way in [(cone, way) for cone in ("pyramid", "ellipsoid", "product") for way in ((1, 0), (0.5**0.5, 0.5**0.5))]:
    gravity = 9.81 * 0.5**0.5 * np.array([*way, -1])
    simulator = qr.Simulator(system, pairs, h=0.01, K_q=np.zeros((0, 0)), cone=cone, gravity=gravity)
    q = [system.q_start]
    for _ in range(50):
        q.append(simulator.step(q[-1], np.zeros(0), np.zeros(6)).q)
    slip = np.hypot(*(q[-1] - q[-2])[:2])  # of a step from rest: h^2 g (1 - mu) / sqrt 2
    print(f"cone {cone}, h = 10 ms: along ({way[0]:.2g}, {way[1]:.2g}) {np.degrees(np.arctan(1 - slip / (0.01**2 * 9.81 * 0.5**0.5))):.3g} deg (Coulomb: 26.6), {(q[-1][2] - 0.02) / slip:.3g} of the slip of a step (Coulomb: 0)")
