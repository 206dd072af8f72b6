"""Which problems ``contact-qp-1`` was made of."""

from typing import Final

SEED: Final = 1
FAMILIES: Final = {
    "sequences": 480,
    "scenarios": 800,
    "time_step": 240,
    "closest_points": 90,
    "contacts": 150,
    "mass_ratio": 300,
    "bodies": 60,
    "condition": 320,
    "gaps": 280,
    "friction": 320,
    "copies": 240,
    "near_copies": 320,
    "narrow": 280,
    "wedge": 240,
    "infeasible": 300,
    "ellipsoid": 200,
    "sparse": 24,
}
"""Problems of each family; ``sequences`` takes whole windows of every scenario."""
