"""Any scene at one instant: bodies, clouds, contact frames, friction cones and forces, to scale."""

from collections.abc import Collection, Iterable, Sequence
from typing import Any, Final

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from numpy.typing import ArrayLike

from quasistatic_ref.errors import InputError, check_kind
from quasistatic_ref.numbers.arrays import Array
from quasistatic_ref.optional.show.figures.camera import Camera
from quasistatic_ref.optional.show.figures.looks import CONE_EDGE, CONE_FACE, FORCE
from quasistatic_ref.optional.show.figures.moments import (
    DrawnContact,
    Moment,
    box_of,
    extent,
    middle,
)
from quasistatic_ref.optional.show.figures.pens import (
    MILLI,
    PLANES,
    Pen,
)
from quasistatic_ref.optional.show.figures.style import legend_above, scaled
from quasistatic_ref.optional.show.loads import BEARING
from quasistatic_ref.quoting import listed

PARTS: Final = ("contacts", "frames", "cones", "forces")
"""What of contacts can be drawn."""
DRAWN: Final = ("contacts", "forces")
"""What of them is drawn by default: a cone is often larger than the object that it hides."""
LONGEST, FRAME = 0.4, 0.1
"""Of the scene's size: the longest force, where no scale is given; the axes of a contact frame."""

MARGIN, PADDING = 1.1, 0.1
"""Around everything, as a factor; and on each side, as a share of half the scene's size."""

SIGNS: Final = np.array([[-1.0], [1.0]])
FRAME_LINES = (("$d_1$", "--"), ("$d_2$", ":"), ("$n$", "-"))


def draw_scene(
    axes: Axes,
    of: Moment,
    *,
    view: str | Camera = "xz",
    parts: Collection[str] = DRAWN,
    metres_per_newton: float | None = None,
    around: tuple[ArrayLike, float] | None = None,
    legend: bool = True,
) -> None:
    """Draw a moment on axes, in millimetres, as a camera sees it.

    Robots are grey, what they act on is coloured. At each contact that bears load stands the force
    on beta's body. The part ``"frames"`` adds its frame (n solid, d1 dashed, d2 dotted). The part
    ``"cones"`` adds the cone of forces that friction allows at its normal force and, where mu_omega
    is not 0, a circle of that radius in the tangent plane: drawn in full when the torque about n is
    at its limit, in part below.

    Parameters
    ----------
    axes : Axes
    of : Moment
    view : str or Camera
        ``"xy"``, ``"xz"``, ``"yz"``, or any orthographic camera, whose axes have no coordinates:
        ``CAMERA`` of ``looks`` is that of all figures here.
    parts : collection of str
        Of ``"contacts"``, ``"frames"``, ``"cones"`` and ``"forces"``.
    metres_per_newton : float, optional
        Length of a force of 1 N [m/N]; by default the largest in view fits.
    around : tuple of ndarray and float, optional
        Centre, shape (3,), and half the width [m] of what is shown; everything by default.
    legend : bool
        Whether to write above the axes what is what, and the scale of forces.

    Raises
    ------
    InputError
        If the view or a part is none of these.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> axes = Figure().subplots()
    >>> scenario = qr.load_scenario("block_push", steps=1)
    >>> qr.draw_scene(axes, qr.figures.moment(scenario, scenario.run(progress=False), 0))
    >>> axes.get_xlabel()
    'x [mm]'
    """
    for part in parts:
        if part not in PARTS:
            problem = f"must be some of {listed(sorted(PARTS))}"
            raise InputError(problem, field="parts", value=part)
    check_kind(of, Moment, "of", "a Moment, as figures.moment makes it")
    box = extent(of)
    if around is not None:
        box = np.asarray(around[0]) + around[1] * SIGNS
    centre, half = middle(box)
    half = MARGIN * half
    if metres_per_newton is None:
        metres_per_newton = force_scale([of], view, half)
    pen = Pen(axes, camera_of(view))
    pen.bodies(of, centre, half)
    for contact in of.contacts:
        if "contacts" in parts:
            pen.dot(contact.beta, contact.bears)
        if contact.bears:
            _draw_contact(pen, contact, parts, metres_per_newton, 2 * FRAME * half)
    if around is None:
        tips = [c.beta + metres_per_newton * at for c in of.contacts for at in _tips(c, parts)]
        box = box_of(np.array([*box, *tips]))
        centre = box.mean(axis=0)
    pen.finish(centre + (box - centre) * MARGIN + PADDING * half * SIGNS, view)
    if legend and of.contacts:
        _legend(axes, of, parts, metres_per_newton)


def draw_scenes(
    panels: Sequence[Axes], moments: Sequence[Moment], *, view: str | Camera = "xz", **options: Any
) -> None:
    """Draw moments in panels that show the same part of the world, with one scale of forces.

    Parameters
    ----------
    panels : sequence of Axes
    moments : sequence of Moment
        One for each panel.
    view : str or Camera
    options
        Further arguments of :func:`draw_scene`.

    Examples
    --------
    >>> from matplotlib.figure import Figure
    >>> panels = Figure().subplots(1, 2)
    >>> scenario = qr.load_scenario("block_push", steps=2)
    >>> run = scenario.run(progress=False)
    >>> qr.draw_scenes(panels, [qr.figures.moment(scenario, run, k) for k in (0, 1)])
    >>> panels[0].get_xlim() == panels[1].get_xlim()
    True
    """
    check_kind(panels, Iterable, "panels", "a list of axes")
    check_kind(moments, Iterable, "moments", "a list of moments")
    for of in moments:
        check_kind(of, Moment, "moments", "a list of moments, as figures.moment makes them")
    fixed = in_common(moments, view) | options
    for axes, of in zip(panels, moments, strict=True):
        draw_scene(axes, of, **fixed)


def in_common(moments: Sequence[Moment], view: str | Camera) -> dict[str, Any]:
    """Arguments of :func:`draw_scene` that several moments of one view share: place and scale."""
    centre, half = middle(box_of(np.concatenate([extent(of) for of in moments])))
    scale = force_scale(moments, view, half)
    return {"view": view, "around": (centre, half), "metres_per_newton": scale}


def _tips(of: DrawnContact, parts: Collection[str]) -> list[Array]:
    """Forces up to which a contact is drawn, each of shape (3,) [N]."""
    rim = list(of.rim) if "cones" in parts and of.mu_v > 0 else []
    return [*rim, of.force] if "forces" in parts else rim


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


def camera_of(view: str | Camera) -> Camera:
    """The camera of a view: a camera itself, or one of ``PLANES`` by its name.

    Raises
    ------
    InputError
        If the name is none of these.
    """
    if isinstance(view, Camera):
        return view
    if not isinstance(view, str) or view not in PLANES:
        problem = f"must be a Camera or one of {listed(sorted(PLANES))}"
        raise InputError(problem, field="view", value=view)
    return PLANES[view]


def force_scale(
    moments: Sequence[Moment], view: str | Camera | None, half: float, longest: float = LONGEST
) -> float:
    """Length at which a force of 1 N is drawn so that the largest in view fits [m/N].

    Zero where there are no forces.

    Parameters
    ----------
    moments : sequence of Moment
    view : str, Camera or None
        None in three dimensions. What of a force is along the view cannot be seen.
    half : float
        Half the scene's size [m].
    longest : float
        Length of the largest force over the scene's size [-].
    """
    forces = np.array([c.force for m in moments for c in m.contacts]).reshape(-1, 3)
    most = seen = float(np.linalg.norm(forces, axis=1).max(initial=0.0))
    if view is not None:
        seen = float(np.linalg.norm(camera_of(view).seen(forces)[:, :2], axis=1).max(initial=0.0))
    if seen < BEARING * most:  # every force is along the view
        seen = most
    return round_scale(2 * longest * half / seen) if seen > 0 else 0.0


def round_scale(scale: float) -> float:
    """Largest of 1, 2, 5 times a power of ten that is not above `scale` [of the same unit]."""
    power = 10.0 ** np.floor(np.log10(scale))
    return float(power * max(m for m in (1, 2, 5) if m <= scale / power + 1e-9))


def _legend(axes: Axes, of: Moment, parts: Collection[str], scale: float) -> None:
    """Write above the axes what each colour and line stands for."""
    handles: list[Artist] = []
    if "forces" in parts and scale > 0:
        label = f"{of.newton} is {MILLI * scale:g} mm"
        handles.append(Line2D([], [], color=FORCE, marker=">", markersize=scaled(4), label=label))
    if "cones" in parts and any(c.bears and c.mu_v > 0 for c in of.contacts):
        label = "friction cone"
        handles.append(Patch(facecolor=CONE_FACE, edgecolor=CONE_EDGE, alpha=0.5, label=label))
    if "frames" in parts and any(c.bears for c in of.contacts):
        for label, dashes in FRAME_LINES:
            handles.append(Line2D([], [], color="black", ls=dashes, lw=scaled(0.9), label=label))
    legend_above(axes, handles)
