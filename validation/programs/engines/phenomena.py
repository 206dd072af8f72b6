"""Phenomena that test any engine by its own simulation, and what its answers are worth.

``phenomena.toml`` has scenes, loads and what is expected, as plain data. An engine is a function of
a scene that returns poses; :func:`cells` asks it everything. To ask your own, write such a
function, or a program that reads and writes lines, and run::

    python -m validation.programs.engines.phenomena --command "./my_engine" --h 0.001

The program gets ``{"id", "layer": "phenomena", "input": {"scene", "setting": {"h"}}}`` a line and
answers ``{"id", "output": {"poses": {body: [[x, y, z, qx, qy, qz, qw], ...]}}}``, a pose at each of
the scene's ``times``; docs/engines.md says the rest.
"""

import argparse
import tomllib
from collections.abc import Callable, Collection, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

Simulate = Callable[[dict[str, Any]], dict[str, Any]]
DATA = tomllib.loads((Path(__file__).parent / "phenomena.toml").read_text("utf-8"))
PHENOMENA = {p["name"]: p for p in DATA["phenomenon"]}


@dataclass(frozen=True)
class Cell:
    """What an engine answered to one phenomenon.

    Parameters
    ----------
    phenomenon : str
    value : float or None
        Measured, in the phenomenon's unit; None where nothing was.
    holds : bool
        Whether that is the answer.
    words : str
        How it is printed.
    """

    phenomenon: str
    value: float | None
    holds: bool
    words: str


def scenes(phenomenon: dict[str, Any]) -> Iterator[tuple[float, dict[str, Any]]]:
    """The scenes of a phenomenon, whole, each with its x: a slope, a share of the limit, a grip."""
    grid = phenomenon["times"]
    count = round((grid["last"] - grid["first"]) / grid["every"])
    times = [round(grid["first"] + k * grid["every"], 9) for k in range(count + 1)]
    for run in phenomenon["runs"]:
        scene = DATA["scene"][phenomenon["scene"]]
        yield run["x"], {**scene, "times": times, "loads": run["loads"]}


def cells(simulate: Simulate, h: float, names: Collection[str] = ()) -> Iterator[Cell]:
    """Every phenomenon, or those named, of an engine that takes steps of h [s]."""
    for name in names or PHENOMENA:
        phenomenon = PHENOMENA[name]
        xs = []
        runs = []
        try:
            for x, scene in scenes(phenomenon):
                body = scene["bodies"][0]["name"]
                xs.append(x)
                runs.append(motion(scene["times"], simulate(scene)["poses"][body]))
            value = MEASURES[phenomenon["measure"]](np.array(xs), runs, {**phenomenon, "h": h})
        except (KeyError, ValueError, TypeError, RuntimeError) as trouble:
            yield Cell(name, None, False, f"no answer ({trouble})")
            continue
        yield verdict(phenomenon, value)


def verdict(phenomenon: dict[str, Any], value: float) -> Cell:
    """A cell of what was measured."""
    expected = np.atleast_1d(phenomenon["expected"])
    scale = expected if "cones" in phenomenon else np.ones_like(expected)
    holds = np.abs(value - expected) <= phenomenon["tolerance"] * scale
    words = f"{value:.3g}" if abs(value) < 1000 else f"{value:,.0f}"
    if "cones" in phenomenon:
        words = (
            f"{value:.2f}" if np.isfinite(value) else f"none up to {phenomenon['runs'][-1]['x']:g}"
        )
        words += "".join(f" ({c})" for c, h in zip(phenomenon["cones"], holds, strict=True) if h)
    return Cell(phenomenon["name"], float(value), bool(holds.any()), words)


@dataclass(frozen=True)
class Motion:
    """Of one body at k times [s]: its places [m], turns from one to the next, and about x [rad]."""

    times: np.ndarray
    places: np.ndarray
    turns: np.ndarray
    about_x: np.ndarray

    @property
    def half(self) -> int:
        """Number of the sample from which on it is looked at: the middle one."""
        return len(self.times) // 2


def motion(times: list[float], poses: list[list[float]]) -> Motion:
    """A motion of poses; each turn is below half a revolution."""
    table = np.array(poses, dtype=float)
    if table.shape != (len(times), 7) or not np.isfinite(table).all():
        raise ValueError("poses are no numbers, or not seven at each time")
    q = table[:, 3:] / np.linalg.norm(table[:, 3:], axis=1, keepdims=True)
    w = q[:, 3]
    v = q[:, :3]
    # Of conj(q_k) q_k+1: the vector part stays exact where the turn is small.
    vector = w[:-1, None] * v[1:] - w[1:, None] * v[:-1] - np.cross(v[:-1], v[1:])
    scalar = np.abs((q[:-1] * q[1:]).sum(1))
    turns = 2 * np.arctan2(np.linalg.norm(vector, axis=1), scalar)
    return Motion(np.array(times), table[:, :3], turns, 2 * np.arctan2(q[:, 0], w))


def drift(xs: np.ndarray, runs: list[Motion], _: Any) -> float:
    """Mean speed of the centre of mass over the second half [um/s]."""
    (run,) = runs
    way = np.linalg.norm(run.places[-1] - run.places[run.half])
    return float(1e6 * way / (run.times[-1] - run.times[run.half]))


def spin(xs: np.ndarray, runs: list[Motion], _: Any) -> float:
    """Mean rate of turning over the second half [rad/s]."""
    (run,) = runs
    return float(run.turns[run.half :].sum() / (run.times[-1] - run.times[run.half]))


def limit(xs: np.ndarray, runs: list[Motion], _: Any) -> float:
    """Where the turn of the second half, a line over x, is zero [unit of x]."""
    r = [run.turns[run.half :].sum() for run in runs]
    return float((xs[0] * r[1] - xs[1] * r[0]) / (r[1] - r[0]))


def angle(xs: np.ndarray, runs: list[Motion], _: Any) -> float:
    """Slope at which ways, which are as sin a - mu cos a, are zero: atan mu [deg]."""
    r = [np.linalg.norm(run.places[-1] - run.places[run.half]) for run in runs]
    s = np.sin(np.arctan(xs))
    c = np.cos(np.arctan(xs))
    return float(np.degrees(np.arctan2(r[1] * s[0] - r[0] * s[1], r[1] * c[0] - r[0] * c[1])))


def rise(xs: np.ndarray, runs: list[Motion], phenomenon: Any) -> float:
    """Largest height above that of the start, over the slip of a last step [-]."""
    (run,) = runs
    seconds = run.times[-1] - run.times[-2]
    slip = np.linalg.norm((run.places[-1] - run.places[-2])[:2]) / seconds * phenomenon["h"]
    rest = DATA["scene"][phenomenon["scene"]]["bodies"][0]["xyz"][2]
    return float(max(0.0, run.places[:, 2].max() - rest) / slip)


def rebound(xs: np.ndarray, runs: list[Motion], phenomenon: Any) -> float:
    """Largest height of the gap after the floor was first reached [um]."""
    (run,) = runs
    gap = run.places[:, 2] - 0.05
    reached = np.flatnonzero(gap <= 1e-7)
    return float(1e6 * max(0.0, gap[reached[0] :].max())) if len(reached) else np.inf


def grip(xs: np.ndarray, runs: list[Motion], phenomenon: Any) -> float:
    """Between the largest grip at which the bar turns about the fingers and the next one [N]."""
    turns = np.array([abs(run.about_x[-1] - run.about_x[0]) for run in runs]) > phenomenon["held"]
    if turns[-1]:
        return np.inf
    last = int(np.flatnonzero(turns)[-1]) if turns.any() else -1
    return float((xs[last] + xs[last + 1]) / 2) if last >= 0 else float(xs[0])


MEASURES = {
    "drift": drift, "spin": spin, "limit": limit, "angle": angle,
    "rise": rise, "rebound": rebound, "grip": grip,
}  # fmt: skip


def engine_answer(program: Any, scene: dict[str, Any], setting: dict[str, Any]) -> dict[str, Any]:
    """What a program answers to a scene.

    Raises
    ------
    ValueError
        If that is no output.
    """
    reply = program.ask("scene", "phenomena", {"scene": scene, "setting": setting})
    if reply.kind != "output":
        raise ValueError(reply.said or reply.kind)
    return dict(reply.output)


def main() -> int:
    """Ask a program, and print what it answered; exit status 1 if a cell differs."""
    from quasistatic_ref.lab.vectors.challenge.program import Program

    parser = argparse.ArgumentParser(description="Phenomena, sent to a program.")
    parser.add_argument("--command", required=True)
    parser.add_argument("--h", type=float, default=0.001, help="its time step [s]")
    parser.add_argument("--timeout", type=float, default=600.0, help="for one scene [s]")
    given = parser.parse_args()
    differs = 0
    with Program(given.command, given.timeout) as program:

        def simulate(scene: dict[str, Any]) -> dict[str, Any]:
            return engine_answer(program, scene, {"h": given.h})

        for cell in cells(simulate, given.h):
            differs += not cell.holds
            of = PHENOMENA[cell.phenomenon]
            print(
                f"{'holds  ' if cell.holds else 'differs'} {of['title']}: {cell.words} {of['unit']}"
            )
    return int(differs > 0)


if __name__ == "__main__":
    raise SystemExit(main())
