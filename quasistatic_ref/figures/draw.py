"""Any scene at one instant: bodies, clouds, contact frames, friction cones and forces, to scale."""

from collections.abc import Collection
from typing import Any, Final

import numpy as np
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from quasistatic_ref.figures.camera import Camera
from quasistatic_ref.figures.moments import DrawnContact, Moment, extent
from quasistatic_ref.figures.pens import (
    CONE_EDGE,
    CONE_FACE,
    CONTACT,
    MILLI,
    PLANES,
    Pen,
    Pen2D,
    Pen3D,
)
from quasistatic_ref.figures.style import figure_style, scaled
from quasistatic_ref.step.data import Array

PARTS: Final = ("contacts", "frames", "cones", "forces")
LONGEST, FRAME = 0.3, 0.1
"""Of the scene's size: the longest force, where no scale is given; the axes of a contact frame."""

MARGIN, PADDING = 1.1, 0.1
"""Around everything, as a factor; and on each side, as a share of half the scene's size."""

SIGNS: Final = np.array([[-1.0], [1.0]])
FRAME_LINES = (("$d_1$", "--"), ("$d_2$", ":"), ("$n$", "-"))


def draw_scene(
    axes: Any,
    of: Moment,
    *,
    view: str | Camera = "xz",
    parts: Collection[str] = PARTS,
    metres_per_newton: float | None = None,
    around: tuple[Array, float] | None = None,
    legend: bool = True,
) -> None:
    """Draw a moment on axes, in millimetres: in 3D if the axes are, else as a camera sees it.

    Bodies are grey, clouds blue dots. At each contact that bears load: its frame (n solid, d1
    dashed, d2 dotted), the cone of forces that friction allows at its normal force, and the force
    on beta's body. Where mu_omega is not zero, a circle of that radius in the tangent plane: drawn
    in full when the torque about n is at its limit, in part below.

    Parameters
    ----------
    axes : Axes or Axes3D
    of : Moment
    view : str or Camera
        Of axes that are not 3D: ``"xy"``, ``"xz"``, ``"yz"``, or any orthographic camera, whose
        axes have no coordinates.
    parts : collection of str
        Of ``PARTS``.
    metres_per_newton : float, optional
        Length of a force of 1 N [m/N]; by default the largest fits.
    around : tuple of ndarray and float, optional
        Centre, shape (3,), and half the width [m] of what is shown; everything by default.
    legend : bool
        Whether to write above the figure what is what, and the scale of forces.
    """
    box = extent(of)
    if around is not None:
        box = around[0] + around[1] * SIGNS
    centre, half = box.mean(axis=0), MARGIN * float(np.ptp(box, axis=0).max()) / 2
    most = max((float(np.linalg.norm(c.force)) for c in of.contacts), default=0.0)
    if metres_per_newton is None:
        metres_per_newton = round_scale(2 * LONGEST * half / most) if most > 0 else 0.0
    camera = PLANES[view] if isinstance(view, str) else view
    pen: Pen = Pen3D(axes) if axes.name == "3d" else Pen2D(axes, camera)
    pen.bodies(of, centre, half)
    for contact, bears in zip(of.contacts, of.bearing, strict=True):
        if "contacts" in parts:
            pen.dot(contact.beta, bool(bears))
        if bears:
            _draw_contact(pen, contact, parts, metres_per_newton, 2 * FRAME * half)
    pen.finish(centre + (box - centre) * MARGIN + PADDING * half * SIGNS, view)
    if legend and of.contacts:
        with figure_style():
            _legend(axes, of, parts, metres_per_newton)


def _draw_contact(
    pen: Pen, of: DrawnContact, parts: Collection[str], scale: float, size: float
) -> None:
    if "cones" in parts and of.mu_v > 0 and len(of.rim) > 2:
        pen.hull(np.vstack([of.beta, of.beta + scale * of.rim]))
    if "frames" in parts:
        for axis, (_, dashes) in zip(of.frame, FRAME_LINES, strict=True):
            pen.line(np.stack([of.beta, of.beta + size * axis]), "black", dashes, 0.9)
    if "cones" in parts and of.mu_omega > 0:
        used = min(abs(of.torque) / (of.mu_omega * of.f_n), 1.0)
        turn = np.linspace(0, 2 * np.pi * used * np.sign(of.torque), 60)
        d1, d2, _ = of.frame
        circle = np.outer(np.cos(turn), d1) + np.outer(np.sin(turn), d2)
        pen.line(of.beta + of.mu_omega * circle, CONE_EDGE, "-", 1.4)
    if "forces" in parts:
        pen.arrow(of.beta, scale * of.force)


def round_scale(scale: float) -> float:
    """Largest of 1, 2, 5 times a power of ten that is not above `scale` [of the same unit]."""
    power = 10.0 ** np.floor(np.log10(scale))
    return float(power * max(m for m in (1, 2, 5) if m <= scale / power + 1e-9))


def _legend(axes: Any, of: Moment, parts: Collection[str], scale: float) -> None:
    """One line above the figure."""
    handles: list[Any] = []
    if "forces" in parts and scale > 0:
        label = f"force: 1 N is {MILLI * scale:g} mm"
        handles.append(Line2D([], [], color=CONTACT, marker=">", markersize=scaled(4), label=label))
    rough = [c for c, bears in zip(of.contacts, of.bearing, strict=True) if bears and c.mu_v > 0]
    if "cones" in parts and rough:
        label = "what friction allows"
        handles.append(Patch(facecolor=CONE_FACE, edgecolor=CONE_EDGE, alpha=0.5, label=label))
    if "frames" in parts and of.bearing.any():
        for label, dashes in FRAME_LINES:
            handles.append(Line2D([], [], color="black", ls=dashes, lw=scaled(0.9), label=label))
    if handles:
        axes.get_figure().legend(
            handles=handles, ncols=len(handles), loc="outside upper center",
            columnspacing=1.0, handlelength=1.8,
        )  # fmt: skip
