"""A block on one soft contact, pushed off its centre by a round finger: steps of six variables."""

from itertools import pairwise

from tests.files.urdf.urdf_texts import collision, inertial, joint, link, robot
from tests.optional.words import AXES, TIP, driven, placed, slides
from tests.scenes import scene

FACE, TOP = 0.05, 0.02
"""From the block's centre [m]."""
TIP_RADIUS = 0.01
"""Of the finger [m]."""

LINKS = ("ground", "x", "y", "z")
SMALL = inertial("0.001", ("1e-4",) * 3)
BLOCK = robot(
    *(link(name, inertial=SMALL) for name in LINKS),
    *(joint(way, of, way, "prismatic", AXES[way]) for of, way in pairwise(LINKS)),
    link(
        "block",
        collision('<box size="0.1 0.1 0.04"/>') + collision('<sphere radius="0.02"/>'),
        inertial("0.8", ("1e-3", "1e-3", "1.3e-3")),
    ),
    joint("turn", "z", "block", "continuous"),
)
"""It stays level: x, y, z and a turn about z. The lowest point of the sphere touches the floor."""


def pushed_block(x, y, turn=0.0, **more):
    """A scenario: the finger at x, y [m] from the block, which is turned [rad]; 20 mm/s along x."""
    targets = [{"t": 0.0, "x": 0.0, "y": 0.0}, {"t": 1.0, "x": 0.02, "y": 0.0}]
    hand = driven(slides("xy", TIP), (x, y, TOP), {"x": 2000.0, "y": 2000.0}, targets)
    block = placed(BLOCK, (0.0, 0.0, TOP), positions={"turn": turn})
    contacts = {
        "support": ("floor", "block/block#1", 0.35, 1, 0.012),
        "push": ("hand/tip", "block/block#0", 0.5, 1),
    }
    return scene({"hand": hand, "block": block}, contacts, 8, **more)
