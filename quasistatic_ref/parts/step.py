"""What a step asks of parts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from quasistatic_ref.parts import needing

if TYPE_CHECKING:
    from quasistatic_ref.step.cones import FrictionCone


def ellipsoid_cone() -> FrictionCone:
    """``cone = "ellipsoid"``."""
    with needing('cone = "ellipsoid"'):
        from quasistatic_ref.optional.ellipsoid.cone import ELLIPSOID_CONE
    return ELLIPSOID_CONE
