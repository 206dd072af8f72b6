"""Bodies with joints of every kind."""

import quasistatic_ref as qr
from tests.files.urdf.urdf_texts import inertial, joint, link, mimic, robot

STONE = robot(link("stone", "", inertial("0.3", ("3e-4",) * 3)))
WHEELS = robot(
    *(link(name, "", inertial("1", ("0.1",) * 3)) for name in ("axle", "wheel", "near", "far")),
    joint("turn", "axle", "wheel", "continuous", "0 0 1"),
    joint("open", "axle", "near", "prismatic", "1 0 0"),
    joint("shut", "axle", "far", "prismatic", "-1 0 0", mimic("open")),
)


def every_joint():
    """Bases that are held and free, in the plane and about a point; joints turn, slide, mimic."""
    return qr.System(
        [
            qr.Body("held", STONE, "floating", ("base",), xyz=(0.3, 0, 0)),
            qr.Body("wheels", WHEELS, "planar", ("base", "turn", "open"), xyz=(0.1, 0.2, 0.0)),
            qr.Body("free", STONE, "floating", (), xyz=(0, 1, 0)),
            qr.Body("hung", STONE, "ball", (), xyz=(0, 0, 1)),
            qr.Body("loose", WHEELS, "floating", ()),
        ]
    )
