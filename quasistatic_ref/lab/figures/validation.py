"""The figures of claims, each drawn from what was measured for it."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from quasistatic_ref.lab.figures.labels import caption, label_axes, legend_below
from quasistatic_ref.lab.figures.line_styles import MARKS
from quasistatic_ref.optional.show.figures.style import panels, scaled

Picture = Mapping[str, Any]
THIN: dict[str, Any] = {"color": "black", "linewidth": 1, "linestyle": "-"}
"""Lines of closed forms."""
DOTTED: dict[str, Any] = {**THIN, "linestyle": ":"}
"""Lines of limits."""
GREYS = ("0.2", "0.42", "0.64", "0.82", "1.0")


def _hollow_marks(mark: str) -> dict[str, Any]:
    """Hollow marks, each kind of another size: equal values stay visible."""
    size = scaled(9 - 2.75 * MARKS.index(mark))
    return {"linestyle": "", "marker": mark, "markersize": size, "fillstyle": "none"}


def grasp(picture: Picture) -> Figure:
    """Rotation of the bunny during the lift."""
    figure, (axes,) = panels(4.6, 2.8)
    for case, angle in picture["angles"].items():
        axes.plot(picture["times"], angle, label=case)
    label_axes(axes, "time t [s]", "rotation since the grip closed [deg]", caption(picture["h"]))
    return figure


def contact_geometry(picture: Picture) -> Figure:
    """Two bodies, their closest points, phi and the frame; in the plane of d1 or d2 and n."""
    data = picture["outline"]
    figure, (axes,) = panels(4.6, 3.2)
    for body in ("capsule", "box"):
        axes.fill(1e3 * data[body][:, 0], 1e3 * data[body][:, 2], facecolor="0.88", edgecolor="0.3")
    alpha = 1e3 * data["alpha"][[0, 2]]
    beta = 1e3 * data["beta"][[0, 2]]
    axes.plot(*np.stack([alpha, beta]).T, **DOTTED)
    for name, point, mark, aside in ((r"$\alpha$", alpha, "o", -14), (r"$\beta$", beta, "s", 4)):
        axes.plot(*point, marker=mark, color="black", linestyle="", markersize=scaled(4))
        offset = scaled(aside), scaled(-12)
        axes.annotate(name, point, xytext=offset, textcoords="offset points")
    for name in ("n", "d1", "d2"):
        arrow = 25 * data[name][[0, 2]]
        if np.linalg.norm(arrow) < 1:
            continue  # it points out of the page
        axes.annotate("", beta + arrow, xytext=beta, arrowprops={"arrowstyle": "->"})
        axes.annotate(f"${name[0]}{'_' + name[1] if name[1:] else ''}$", beta + 1.15 * arrow)
    axes.set_aspect("equal")
    gap = 1e3 * data["phi"][0]
    title = rf"a capsule and a box, $\phi$ = {gap:.1f} mm; $d_1$ is normal to the page"
    label_axes(axes, "x [mm]", "z [mm]", title)
    return figure


def boundary_layer(picture: Picture) -> Figure:
    """Spin and lift-off against torque; size of the layer against the time step."""
    figure, (left, right) = panels(6.3, 2.8, columns=2)
    left.plot(1e3 * picture["torque"], 1e3 * picture["lift"])
    left.axvline(1e3 * picture["limit"], **DOTTED)
    left.annotate(
        r"$\mu_\omega\,m\,g$", (1e3 * picture["limit"], 0.6), xycoords=("data", "axes fraction"),
        xytext=(-4, 0), textcoords="offset points", ha="right",
    )  # fmt: skip
    label_axes(left, "applied torque [mN m]", "lift-off [mm]", caption(picture["h"]))
    sizes = 1e3 * picture["sizes"]
    right.loglog(sizes, 1e6 * picture["at_rate"], marker="o", label="fixed rate: slope 1")
    right.loglog(sizes, 1e6 * picture["at_torque"], marker="s", label="fixed torque: slope 2")
    label_axes(right, "time step h [ms]", r"boundary layer [$\mu$m]", "friction pyramid")
    return figure


def step_time(picture: Picture) -> Figure:
    """Parts of a step by backend, stacked."""
    figure, (axes,) = panels(6.3, 3.4)
    profiles = picture["profiles"]
    at = -np.arange(len(profiles))
    times = np.array([list(p.typical.values()) for p in profiles])
    whole = times.sum(axis=1)
    shares = 100 * times / whole[:, None]
    left = np.zeros(len(profiles))
    for part, width, grey in zip(profiles[0].typical, shares.T, GREYS, strict=True):
        axes.barh(at, width, 0.8, left=left, label=part, color=grey, edgecolor="black",
                  linewidth=scaled(0.5))  # fmt: skip
        left += width
    axes.axvline(50, color="black", linestyle=":", linewidth=scaled(1.2))
    for y, p, total in zip(at, profiles, whole, strict=True):
        text = f"{100 * p.solve:.0f} % of {_duration(total)}"
        axes.annotate(text, (102, y), va="center", annotation_clip=False)
    axes.set_yticks(at, [p.backend.replace("qpsolvers:", "qpsolvers:\n") for p in profiles])
    axes.grid(False)
    axes.set(xlim=(0, 100), xticks=range(0, 101, 25))
    label_axes(
        axes, "share of the time of a step, medians [%]", title=caption(picture["h"]), key=False
    )
    words = f"all {picture['all']} distances in each step; right: share of the solve"
    legend_below([axes], axes.get_legend_handles_labels()[0], words)
    return figure


def _duration(microseconds: float) -> str:
    ms = microseconds >= 1000
    return f"{microseconds / 1000:.1f} ms" if ms else rf"{microseconds:.0f} $\mu$s"


def sliding_threshold(picture: Picture) -> Figure:
    """Least force that moves a point, by direction: the pyramid and Coulomb's circle."""
    figure, (axes,) = panels(4.6, 2.8)
    degrees = np.degrees(picture["angles"])
    axes.plot(degrees, np.ones_like(degrees), color="0.5", linestyle=":", label="Coulomb's circle")
    exact = 1 / (np.cos(picture["angles"]) + np.sin(picture["angles"]))
    axes.plot(degrees, exact, label="(R7)", **THIN)
    for mu, measured, mark in zip(picture["mus"], picture["found"], MARKS, strict=False):
        axes.plot(degrees, measured, **_hollow_marks(mark), label=rf"$\mu_v$ = {mu:g}")
    least = r"least force / ($\mu_v m g$) [-]"
    label_axes(axes, "direction of the force from $d_1$ [deg]", least, caption(picture["h"]))
    return figure


def pushed_block(picture: Picture) -> Figure:
    """Force of the finger over friction, against the quasi-dynamic number."""
    figure, (axes,) = panels(4.6, 2.8)
    friction = picture["mu"] * picture["m"] * 9.81
    pi = picture["v"] / (picture["mu"] * 9.81 * picture["h"])
    line = np.geomspace(0.8 * pi.min(), 1.2 * pi.max(), 100)
    axes.plot(line, 1 + line, label=r"$1 + \Pi$, (R13)", **THIN)
    for h, mark in zip(np.unique(picture["h"]), MARKS, strict=False):
        at = picture["h"] == h
        force = picture["force"][at] / friction[at]
        axes.plot(pi[at], force, **_hollow_marks(mark), label=f"h = {1e3 * h:g} ms")
    axes.axhline(1, color="0.5", linestyle=":", linewidth=1)
    axes.set(xscale="log", yscale="log")
    speed = r"quasi-dynamic number $\Pi = v / (\mu_v g h)$ [-]"
    label_axes(axes, speed, r"push / ($\mu_v m g$) [-]", "friction pyramid")
    return figure


def planar_push(picture: Picture) -> Figure:
    """Turn of a pushed slider over that of the quasi-static law, against its speed."""
    figure, (axes,) = panels(4.6, 2.8)
    rho = picture["rho"]
    line = np.geomspace(0.8 * picture["Pi"].min(), 1.2 * picture["Pi"].max(), 100)
    for (c, ratio), mark in zip(picture["turns"].items(), MARKS, strict=False):
        axes.plot(line, (1 + line) / (1 + line * (rho / c) ** 2), **THIN)
        label = rf"c = {1e3 * c:g} mm, $\rho$ = {1e3 * rho:g} mm"
        axes.plot(picture["Pi"], ratio, **_hollow_marks(mark), label=label)
    axes.set_xscale("log")
    title = f"{caption(picture['h'], 'ellipsoid')}; lines: (R28)"
    label_axes(axes, r"quasi-dynamic number $\Pi$ [-]", "turn / Lynch's turn [-]", title)
    return figure


def patch_torsion(picture: Picture) -> Figure:
    """mu_omega of patches made of rings, and their limits."""
    figure, (axes,) = panels(4.6, 2.8)
    for (name, measured), mark in zip(picture["found"].items(), MARKS, strict=False):
        axes.plot(picture["rings"], measured, marker=mark, label=name)
        axes.axhline(picture["limits"][name], **DOTTED)
    axes.set_xscale("log", base=2)
    axes.set_xticks(picture["rings"], [str(n) for n in picture["rings"]])
    title = "h = 10 ms, friction pyramid; dotted: continuum"
    label_axes(axes, "rings of point contacts [-]", r"$\mu_\omega$ / ($\mu$ a) [-]", title)
    return figure


def flat_patch(picture: Picture) -> Figure:
    """Who bears the load of a rigid disk that turns."""
    figure, (axes,) = panels(4.6, 2.6)
    at = np.arange(len(picture["r"]))
    uniform = np.full(len(at), 1 / len(at))
    axes.set_axisbelow(True)
    axes.bar(at - 0.2, uniform, 0.4, color="white", edgecolor="black", label="uniform load")
    axes.bar(at + 0.2, picture["shares"], 0.4, color="0.5", edgecolor="black", label="this model")
    axes.set_xticks(at, [f"{1e3 * r:.0f}" for r in picture["r"]])
    radius = "radius of the ring of points [mm]"
    label_axes(axes, radius, "share of the load [-]", caption(picture["h"]))
    return figure


def peg_wedging(picture: Picture) -> Figure:
    """Depth at which a peg stops to wedge, against Whitney's line."""
    figure, (axes,) = panels(4.6, 2.8)
    line = np.array([0, 0.9])
    axes.plot(line, line, label=r"$l = \mu d$, (R17)", **THIN)
    for width, mark in zip(np.unique(picture["width"]), MARKS, strict=False):
        at = picture["width"] == width
        ratio = picture["found"][at] / width
        label = f"d = {1e3 * width:g} mm"
        axes.plot(picture["mu"][at], ratio, **_hollow_marks(mark), label=label)
    axes.annotate("slides in", (0.3, 0.5))
    axes.annotate("wedged", (0.6, 0.15))
    title = f"{caption(picture['h'])}; pushes of 1 mN to 1 MN"
    label_axes(axes, r"$\mu$ [-]", "depth / width, l / d [-]", title)
    return figure


def mujoco_friction(picture: Picture) -> Figure:
    """Velocity against load, below and beyond the threshold, of both engines."""
    figure, both = panels(6.3, 2.8, columns=2)
    units = {"torsion": "spin rate [rad/s]", "tangent": "velocity [m/s]"}
    for axes, (kind, unit) in zip(both, units.items(), strict=True):
        for (what, cone), final in picture["creep"].items():
            if what == kind:
                mark = MARKS[len(axes.lines)]
                axes.plot(picture["shares"], np.abs(final), marker=mark, label=f"MuJoCo, {cone}")
        ours = picture["ours"][kind]
        axes.plot(picture["shares"], ours, marker="D", label="ours, pyramid, one step")
        axes.set_yscale("symlog", linthresh=1e-5)
        axes.axvline(1, **DOTTED)
        axes.set(xlabel="load / what friction can hold [-]", ylabel=unit)
        axes.set_title(f"{kind}, h = {1e3 * picture['h']:g} ms", loc="right")
    legend_below(both, both[0].get_legend_handles_labels()[0])
    return figure


def locked_guide(picture: Picture) -> Figure:
    """What a force does to a body in a guide, and how far any force takes it in a step."""
    figure, (left, right) = panels(6.3, 3.0, columns=2)
    forces = picture["forces"]
    left.plot(forces, np.minimum(forces, 1.0), label=r"slip / (c / $\mu_v$), (R38)")
    left.plot(forces, picture["slips"], **_hollow_marks("o"), label="of steps")
    left.plot(forces, picture["friction"], linestyle=":", label="friction of the walls")
    of_force = r"force / ($m\,c\,/\,\mu_v h^2$) [-]"
    label_axes(left, of_force, "slip and friction [-]", caption(picture["h"]))
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1], [1, 1]])
    right.plot(*corners.T, label=r"$c / \mu_v$ along $d_1$ and $d_2$")
    right.plot(*picture["reached"].T, **_hollow_marks("s"), label="1 MN in 24 directions")
    right.set(xlim=(-1.6, 1.6), ylim=(-1.6, 1.9), aspect="equal")
    label_axes(right, r"slip along $d_1$ / ($c / \mu_v$) [-]", r"along $d_2$ [-]", "one step")
    return figure


PICTURES: dict[str, Callable[..., Figure]] = {
    draw.__name__: draw
    for draw in (
        grasp, contact_geometry, boundary_layer, step_time, sliding_threshold, pushed_block,
        patch_torsion, flat_patch, peg_wedging, locked_guide, mujoco_friction, planar_push,
    )
}  # fmt: skip
"""Claim -> its figure, of what was measured."""
