"""Shapes and poses as the cases of the layer `distance` hold them."""

FLOOR = {"kind": "halfspace", "normal": [0.0, 0.0, 1.0], "offset": 0.0}
ON_SIDE = [1.0, 0.0, 0.0, 1.0]  # a quarter turn about x: local z becomes -y


def at(x, y, z, quaternion=(0.0, 0.0, 0.0, 1.0)):
    return {"xyz": [x, y, z], "quaternion": list(quaternion)}


ORIGIN = at(0.0, 0.0, 0.0)


def box(*size):
    return {"kind": "box", "size": list(size)}


def sphere(radius):
    return {"kind": "sphere", "radius": radius}


def cylinder(radius, length):
    return {"kind": "cylinder", "radius": radius, "length": length}


def cone(radius, length):
    return {"kind": "cone", "radius": radius, "length": length}


def ellipsoid(*half_axes):
    return {"kind": "ellipsoid", "half_axes": list(half_axes)}


def convex(vertices):
    return {"kind": "convex", "vertices": vertices}
