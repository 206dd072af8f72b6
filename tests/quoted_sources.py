"""Where the numbers of tests/quoted_pages.py come from: runs of the grasp, committed results."""

import json
import math
import re
from functools import cache

import numpy as np

from quasistatic_ref.cli.measures import link_motion
from quasistatic_ref.lab.examples.grasp_against_mu_omega import needed, rotations
from quasistatic_ref.lab.grasp import CASES, TOP, grasp_report
from quasistatic_ref.lab.runs import grasp
from tests.quoted import ROOT, cells, claim

G, H = 9.81, 0.01
"""m/s^2, and the time step of the scenes [s]."""
LIFTING = 137
"""The step of the grasp that the exercises take."""
BENCH = "validation/results/benchmarks/bench.md"
SWEEP = "validation/studies/bunny_torsion/report.md"


# -- The grasp -----------------------------------------------------------------------------------
def turned(mu_omega):
    """How far the bunny turns in the lift [deg], with mu_omega in mm."""
    at, found = rotations()
    return found[np.abs(at - 1e-3 * mu_omega).argmin()]


def both_turns():
    return [claim("grasp", f"rotation {case} torsion [deg]") for case in ("without", "with")]


@cache
def levers():
    """Lengths at step 137 [mm]: levers behind the centre of mass, its height, tau_n over a force.

    The levers are those of the middle of the fingertips and of the two points that bear load; the
    height is over the origin of the bunny; the force is the vertical one.
    """
    scenario, run = grasp("with torsion")
    urdf = (ROOT / "models" / "bunny_grasp" / "bunny.urdf").read_text()
    c = np.array(re.search(r'xyz="([^"]+)"', urdf)[1].split(), float)
    kinematics, link = scenario.system.kinematics(run["q"][LIFTING]), scenario.system.link("bunny")
    centre = kinematics.R[link] @ c + kinematics.t[link]
    wrench, fingers = run["wrench"][LIFTING], run["rows"] == 6
    loaded = np.flatnonzero(fingers & (wrench[:, 2] > 0))
    points = np.sort(run["beta"][LIFTING][loaded, 0] - centre[0])
    middle = run["q_bar_a"][LIFTING][0] - centre[0]
    up = np.abs(wrench[loaded, 1]).sum()
    return 1e3 * np.array([middle, *points, c[2], np.abs(wrench[loaded, 3]).sum() / up])


def pressed():
    """With how much each finger presses at step 137 [N]: their mean."""
    _, run = grasp("with torsion")
    return run.step_forces(LIFTING)[run["rows"] == 6, 2].sum() / 2


def weight_alone():
    """mu_omega [mm] that (R9) asks for where step 137's load is that of the weight alone."""
    _, run = grasp("with torsion")
    f_1, f_2, f_n, tau_n = np.abs(run.step_forces(LIFTING)[run["rows"] == 6]).sum(axis=0)
    share = 0.2 * G / f_2
    return 1e3 * share * tau_n / (f_n - share * (f_1 + f_2) / 0.6)


def least():
    """mu_omega [mm] that (R9) asks for with the forces of that step."""
    return 1e3 * needed(grasp("with torsion")[1])


def one_in(share):
    """A share in words."""
    return {3: "a third", 5: "a fifth"}[round(1 / share)]


def foot_on_the_floor():
    """Until when the bunny without torsion stands on the floor [s]."""
    _, run = grasp("without torsion")
    load = run["wrench"][:, run["rows"] == 4, 2].sum(axis=1)
    return run["t"][np.flatnonzero(load)[-1]]


def drag():
    """Halfway through the lift [N], over weight, over friction; the run's largest share."""
    _, run = grasp("with torsion")
    force = 0.2 * 0.04 / 2.2 / H
    friction = run["mu_v"] @ run["wrench"][150, :, 2]
    return force, force / (0.2 * G), force / friction, run.header["largest_drag_share"]


def since_the_start():
    """How far the bunny turns [deg], from the first step on."""
    scenario, run = grasp("with torsion")
    return np.degrees(link_motion(scenario.system, run, "bunny").largest_rotation)


def demo_lines():
    """The lines of what demo prints that the quickstart shows."""
    reports = [grasp_report(*grasp(case)) for case in CASES]
    angle, lift = ([r[key] for r in reports] for key in ("rotation_deg", "lift_mm"))
    label = f"t = 0.7 to {TOP:g} s"
    return (
        f"rotation of the bunny, {label}, at most [deg] {angle[0]:.3f} {angle[1]:.3f} "
        f"lift height, {label} [mm] {lift[0]:.2f} {lift[1]:.2f}"
    )


# -- Committed results ---------------------------------------------------------------------------
def sweep_turns(*mu_omega):
    """Rotations of the sweep at these mu_omega [m] and every h."""
    rows = cells(SWEEP, "mu_omega and h")
    found = [(float(r["mu_omega [m]"]), float(r["largest rotation [deg]"])) for r in rows]
    return [degrees for at, degrees in found if at in mu_omega]


def sweep_of(section, column):
    """A column of another sweep, by its first column."""
    rows = cells(SWEEP, section)
    return {next(iter(r.values())): float(r[column]) for r in rows}


def problem_set():
    """Problems of contact-qp-2, and its families."""
    manifest = json.loads((ROOT / "validation/contact_qp_2/manifest.json").read_text())
    return [sum(family["count"] for family in manifest["families"].values()),
            len(manifest["families"])]  # fmt: skip


@cache
def cases_of(layer):
    return len(json.loads((ROOT / f"validation/vectors/inputs/{layer}.json").read_text())["cases"])


def largest_error(wanted, *of):
    """Over the pairs of the table of distances that are wanted, of some columns [m]."""
    rows = [
        r
        for r in cells("validation/results/pair_distances.md")
        if wanted(set(r["pair"].split(" - ")))
    ]
    return max(float(row[column]) for row in rows for column in of)


def two_capsules():
    return largest_error(lambda pair: pair == {"capsule"}, "phi", "normal")


def closed_forms():
    """Without two capsules: a sphere or a half-space and anything, and boxes, capsules, meshes."""
    flat = {"box", "capsule", "mesh"}
    return largest_error(
        lambda pair: pair != {"capsule"} and (pair & {"sphere", "half-space"} or pair <= flat),
        "phi",
    )


def decade(x):
    """The exponent of the power of ten above."""
    return math.ceil(math.log10(x))


def base():
    """Size of the base [GB, rounded], the share of its largest part, and the next three."""
    row = next(r for r in cells("validation/results/installs.md") if r["versions"] == "newest")
    parts = [part.rsplit(" ", 1) for part in row["largest parts [MB]"].split(", ")]
    (boost, size), *more = parts[:4]
    assert boost == "cmeel-boost"
    names = {"scs": "SCS", "scipy": "SciPy", "numpy": "NumPy"}
    whole = float(row["MB"])
    gigabytes = "a" if round(whole / 1000) == 1 else f"{whole / 1000:.0f}"
    return [gigabytes, one_in(float(size) / whole), *(names[name] for name, _ in more)]


def native_gains():
    """The lap `solve` through CVXPY over that of the native engine, least and largest."""
    laps = [
        r for r in cells(BENCH, "By part") if r["backend"] in ("clarabel", "osqp", "piqp", "daqp")
    ]
    at = {(r["engine"], r["backend"]): float(r["solve"]) for r in laps}
    gains = [at["cvxpy", b] / at["native", b] for _, b in at]
    return min(gains), max(gains)


def equal_bits():
    text = (ROOT / "validation/results/exact_everywhere.txt").read_text()
    assert text.endswith("all bits equal\n")
    return text


def steps_with_equal_bits():
    """How many of each family."""
    return [int(n) for n in re.findall(r"^\w.*: (\d+) optimal", equal_bits(), re.MULTILINE)]


def unsolved_random_steps(*backends):
    """Random steps that backends leave; each has an answer without a correct digit, too."""
    line = re.search(r"random, until.*?own answer[^:]*: ([^\n]+)", equal_bits(), re.DOTALL)[1]
    found = re.findall(r"(\w+) ([\d.]+) \((\d+)\)", line)
    assert {digits for _, digits, _ in found} == {"0.0"}
    left = {backend: int(count) for backend, _, count in found}
    return [left[backend] or "none" for backend in backends]
