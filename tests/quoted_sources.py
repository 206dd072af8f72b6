"""Where the numbers of tests/quoted.toml come from: runs of the grasp, committed results, code.

Each function is a source, which phrases name: a number, or numbers by what they are.
"""

import json
import math
import re
from functools import cache
from itertools import product
from pathlib import Path
from types import MappingProxyType

import numpy as np
from scipy.integrate import quad

from quasistatic_ref import load_scenario, tolerances
from quasistatic_ref.cli.time_step import time_step_record
from quasistatic_ref.formats.resources import scenario_names
from quasistatic_ref.lab.bench.solids import STATES
from quasistatic_ref.lab.cached_runs import grasp as run_of
from quasistatic_ref.lab.claims.registry import BY_NAME
from quasistatic_ref.lab.clouds import rows as clouds_table
from quasistatic_ref.lab.clouds.rows import rows as cloud_rows
from quasistatic_ref.lab.examples.grasps import grasp_against_mu_omega
from quasistatic_ref.lab.grasp import CASES, TOP, grasp_report
from quasistatic_ref.lab.scenes.rigid import point_step
from quasistatic_ref.lab.thresholds import exact
from quasistatic_ref.lab.vectors.layers import LAYERS
from quasistatic_ref.lab.vectors.versions import RELEASE
from quasistatic_ref.optional.account.motions import link_motion
from quasistatic_ref.optional.derivatives.step.barrier import barrier_step
from quasistatic_ref.optional.fast.compiled import library
from quasistatic_ref.tolerances import ILL_POSED, SLOW, UNSEEN
from tests.analytic.test_flat_patches import patches  # noqa: F401 a source
from tests.helpers import error, pinch
from tests.lab.study.calling.test_known_issues import highs_solved as highs  # noqa: F401 a source
from validation.make.challenges import ANSWERS
from validation.programs.engines.second_order import STUDY
from validation.programs.engines.second_order_page import rows_with as second_order

ROOT = Path(__file__).parents[1]
RESULTS = ROOT / "validation" / "results"
G, H, MASS, SPEED = 9.81, 0.01, 0.2, 0.04 / 2.2
"""m/s^2, the time step [s] of the grasp, the bunny's mass [kg] and its speed in the lift [m/s]."""
LIFTING = 137
"""The step of the grasp that the exercises take."""
PAPERS = 90
"""The paper's bound of its average step [us]."""
WEIGHTS = ("1e-6", "1e-7", "1e-8", "1e-9", "1e-10", "1e-11", "1e-12")
"""Of barriers [N m s]."""
WORDS = (
    "no", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven",
)  # fmt: skip


# -- Files that phrases reach into ----------------------------------------------------------------
def plain(name):
    """A name whose unit stands after a comma: brackets are what a phrase asks with."""
    return name.replace(" [", ", ").removesuffix("]")


class Cell(str):
    """A cell of a table: its text, and where a format asks for one, its number."""

    def __float__(self):
        return float(self.replace(",", "").rstrip(" %"))

    def __format__(self, form):
        return format(float(self), form) if form else str(self)


class Rows(list):
    """Rows of a table: those with a cell, or a column of the only one."""

    def __getitem__(self, name):
        if kept := [row for row in self if name in map(plain, row.values())]:
            return Rows(kept)
        (row,) = self
        (found,) = [cell for column, cell in row.items() if plain(column) == name]
        return found


@cache
def text(file):
    return (RESULTS / file).read_text("utf-8")


@cache
def table(file, heading=""):
    """The first Markdown table after a heading that starts so."""
    after = text(file)
    if heading:
        after = after[re.search(rf"^#+ {re.escape(heading)}.*$", after, re.MULTILINE).end() :]
    lines = re.search(r"(?:^\|.*\n)+", after, re.MULTILINE)[0].splitlines()
    head, _, *rows = ([Cell(c.strip()) for c in line.strip("|").split(" | ")] for line in lines)
    return Rows(dict(zip(map(str.strip, head), row, strict=True)) for row in rows)


@cache
def record(name):
    """A committed JSON file."""
    return json.loads(
        text(f"{name}.json"), object_hook=lambda own: {plain(k): v for k, v in own.items()}
    )


# -- The grasp ------------------------------------------------------------------------------------
def turned():
    """How far the bunny turns in the lift [deg], by mu_omega."""
    at, found = grasp_against_mu_omega.rotations()
    return {f"{1e3 * mu_omega:g} mm": angle for mu_omega, angle in zip(at, found, strict=True)}


def forces():
    """Those of the fingers' contacts at step 137, (f_1, f_2, f_n, tau_n) [N, N m]."""
    _, run = run_of("with torsion")
    return run.step_forces(LIFTING)[run["rows"] == 6]


def levers():
    """Lengths at step 137 [mm].

    Levers behind the centre of mass, of the middle of the fingertips and of the two points that
    bear load; its height over the origin of the bunny; torque over the vertical force.
    """
    scenario, run = run_of("with torsion")
    urdf = (ROOT / "models" / "bunny_grasp" / "bunny.urdf").read_text()
    c = np.array(re.search(r'xyz="([^"]+)"', urdf)[1].split(), float)
    kinematics = scenario.system.kinematics(run["q"][LIFTING])
    link = scenario.system.link("bunny")
    centre = kinematics.R[link] @ c + kinematics.t[link]
    wrench = run["wrench"][LIFTING]
    fingers = run["rows"] == 6
    loaded = np.flatnonzero(fingers & (wrench[:, 2] > 0))
    first, second = np.sort(run["beta"][LIFTING][loaded, 0] - centre[0])
    middle = run["q_bar_a"][LIFTING][0] - centre[0]
    torque = np.abs(wrench[loaded, 3]).sum() / np.abs(wrench[loaded, 1]).sum()
    found = {"middle": middle, "first": first, "second": second, "height": c[2], "torque": torque}
    return {name: 1e3 * length for name, length in found.items()}


def grasp():
    """What the two runs come to, in the units of the phrases."""
    scenario, run = run_of("with torsion")
    _, without = run_of("without torsion")
    standing = np.flatnonzero(without["wrench"][:, without["rows"] == 4, 2].sum(axis=1))
    turned = link_motion(scenario.system, run, "bunny")
    return {
        "lift": 1e3 * float(claims()["grasp"]["lift, m"]["measured"]),
        "pressed": forces()[:, 2].sum() / 2,
        "speed": 1e3 * SPEED,
        "carried": 1e3 * H * SPEED,
        "foot": without["t"][standing[-1]],
        "since the start": np.degrees(turned.rotation_since(0.0).max()),
    }


def drag():
    """Halfway through the lift [N], and its shares [%]; the run's largest share."""
    _, run = run_of("with torsion")
    fingers = run["wrench"][:, run["rows"] == 6, 2].sum(axis=1)
    force = MASS * SPEED / H
    friction = run["mu_v"] @ run["wrench"][150, :, 2]
    return {"force": force, "weight": MASS * G, "of weight": 100 * force / (MASS * G),
            "of friction": 100 * force / friction,
            "touched": run["t"][np.flatnonzero(fingers)[0]],
            "largest share": run.header["largest_drag_share"],
            "largest, %": 100 * run.header["largest_drag_share"]}  # fmt: skip


def demo_lines():
    """The lines of what demo prints that the quickstart shows."""
    reports = [grasp_report(*run_of(case)) for case in CASES]
    angle, lift = ([r[key] for r in reports] for key in ("rotation_deg", "lift_mm"))
    label = f"t = 0.7 to {TOP:g} s"
    return (
        f"largest rotation of the bunny, {label} [deg] {angle[0]:.3f} {angle[1]:.3f} "
        f"lift height, {label} [mm] {lift[0]:.2f} {lift[1]:.2f}"
    )


# -- The code -------------------------------------------------------------------------------------
def package():
    """What is counted or set in it."""
    return {
        "claims": len(BY_NAME),
        "scenarios": WORDS[len(scenario_names())].capitalize(),
        "layers": WORDS[len(LAYERS)],
        "layer count": len(LAYERS),
        "cases": sum(cases().values()),
        "release": RELEASE,
        "challenges": ANSWERS["numpy"],
        "port challenges": ANSWERS["go"],
        "top": TOP,
        "slow share": SLOW,
        "slow": 100 * SLOW,
        "ill-posed": math.log10(ILL_POSED),
    }


@cache
def cases():
    """How many cases each layer of the vectors has."""
    folder = ROOT / "validation" / "vectors" / "inputs"
    return {
        layer: len(json.loads((folder / f"{layer}.json").read_text())["cases"]) for layer in LAYERS
    }


def tracker():
    """Constants of the short lists."""
    source = (library.SOURCE / "closest.c").read_text()
    names = ("RATIO", "SHORT", "WIDE")
    found = {name: re.search(rf"\b{name}(?: =)? ([\d.]+)", source) for name in names}
    return {"UNSEEN": UNSEEN} | {name: float(value[1]) for name, value in found.items()}


# -- Closed forms ---------------------------------------------------------------------------------
def pressures():
    """mu_omega over mu a of a pressure (1 - (r / a)^k)^(1/k), by k."""

    def moment(k, power):
        return quad(lambda r: r**power * (1 - r**k) ** (1 / k), 0, 1)[0]

    return {k: moment(k, 2) / moment(k, 1) for k in (2, 3, 4)}


def finger():
    """mu_omega of a patch as wide as a finger of the grasp [mm], and the radius for 3 mm [mm]."""
    mu_v, width, wanted = 0.6, 12.0, 3.0
    share = {"even": 2 / 3, "Hertz": pressures()[2]}
    radius = {f"radius, {name}": wanted / (mu_v * own) for name, own in share.items()}
    return {name: own * mu_v * width for name, own in share.items()} | radius


def below_the_limit():
    """How far a point slides at 90 % of Coulomb's limit [um], from a gap of 0.25 mm to none."""
    mu_v, phi, slid = 0.5, 0.25e-3, 0.0
    while phi > 0:
        dx, _, dz = exact(point_step(1.0, (0.9 * mu_v * G, 0.0, -G), mu_v, phi, H)).delta_q
        slid += dx
        phi = max(phi + dz, 0.0) if dx else 0.0
    return 1e6 * slid


# -- Committed results ----------------------------------------------------------------------------
@cache
def claims():
    """The table of each claim."""
    return {name: table("claims.md", f"{name}: ") for name in BY_NAME}


def problem_set():
    """Problems of contact-qp-2, and its families."""
    manifest = json.loads((ROOT / "validation/contact_qp_2/manifest.json").read_text())
    count = sum(family["count"] for family in manifest["families"].values())
    return {"count": count, "families": len(manifest["families"])}


def coulomb_modes():
    """How many solutions planar steps have, by their contacts."""
    return {row["contacts"]: row for row in table("coulomb_modes.md")}


@cache
def profile():
    """The medians, these over the paper's step, and signed distances of a step."""
    medians = table("step_profile.md", "Medians")
    steps = {row["backend, distances"]: float(row["step"]) for row in medians}
    words = r"evaluates (\d+) signed distances, with the tracker (\d+) in the mean"
    return {
        "medians": medians,
        "times": {name: us / PAPERS for name, us in steps.items()},
        "distances": [float(n) for n in re.search(words, text("step_profile.md")).groups()],
    }


def large():
    """What the page says of large steps."""
    sparse = table("large_steps.md", "Sparse steps")
    assert {row["without bound"] for row in sparse["piqp"]} == {"0"}
    assert {row["unsolved"] for row in sparse["piqp"]} == {"0"}
    promises = table("large_steps.md", "Promises")
    return {"promises": promises, "heap": sparse["5 x 5 x 4"]}


def proofs():
    """The time of a certified step of each scene of many bodies [ms]; plain over fast."""
    bench = json.loads((RESULTS / "benchmarks/bench.json").read_text())
    found = {name: costs["full"] / 1e3 for name, costs in bench["large"].items()}
    states = [bench["solids"][name] for name in STATES]
    slower = [costs["full, plain"] / costs["full"] for costs in states]
    return found | {"least": min(slower), "most": max(slower)}


def goals():
    """What `bench` measured of each of its goals, and of each scene."""
    bench = json.loads((RESULTS / "benchmarks/bench.json").read_text())
    failed = [p["what"].split(",")[0] for p in bench["promises"] if not p["holds"]]
    missed = ["proved step over one that is not"]
    assert failed == missed, "docs/speed.md names the goals that are missed"
    return bench["grasp"] | bench["solids"] | bench["large"]


def sizes():
    """From how many entries of J on steps are sparse."""
    return vars(tolerances)


def clouds():
    """How many of the 120 clouds of 992 points turn by at most a degree with torsional friction.

    And how far those without holes turn without it [deg].
    """
    grasps = [row for row in cloud_rows() if row["count"] == 992 and row["change"] == "none"]
    turned = [row for row in grasps if row["rotation"] <= 1]
    assert len(grasps) == 240
    assert 0.0 not in [row["mu_omega"] for row in turned]
    whole = [row for row in grasps if row["sampling"] != "scan"]
    angles = [row["rotation"] for row in whole if row["mu_omega"] == 0.0]
    return {"held": len(turned), "whole": len(angles), "least": min(angles), "most": max(angles),
            "whole and held": sum(row in whole for row in turned)}  # fmt: skip


def turns_of_clouds():
    """What the page says of rotations at 100,000 points without torsion, and of the prediction."""
    dense = [row for row in cloud_rows() if row["count"] == 100_000 and row["mu_omega"] == 0.0]
    whole = np.sort([row["rotation"] for row in dense if row["sampling"] != "scan"])
    scans = [row["rotation"] for row in dense if row["sampling"] == "scan"]
    grips = [row for row in cloud_rows() if clouds_table.with_torsion(row)]
    margins = np.array([clouds_table.margin(row) for row in grips])
    held = np.array([clouds_table.is_held(row) for row in grips])
    soft = np.array([(row["change"], row["value"]) == ("arm", 0.1) for row in grips])
    fails = ~held & (margins >= 1)
    return {
        "many": (whole > 55).sum(), "whole": len(whole), "least": whole[0],
        "low": np.quantile(whole, 0.1), "high": np.quantile(whole, 0.9),
        "scans": [min(scans), max(scans)], "grips": len(grips),
        "right": ((margins >= 1) == held).sum(), "fail": fails.sum(),
        "soft": (fails & soft).sum(), "firm": (~held & (margins >= 1.5)).sum(),
        "load": MASS * (G + SPEED / H),
    }  # fmt: skip


class Compared(dict):
    """Runs against second-order simulators, by scene, speed [mm/s], engine and step [ms].

    In mm, mm/s, degrees, and ms for a simulated second or, "step", for a step; "largest": the
    largest step [ms] with a verdict, of the best setting.
    """

    OURS = ("quasistatic_ref", "uncertified")
    ENGINES = MappingProxyType({
        "ours": OURS, "ellipsoid": (OURS[0], "ellipsoid, uncertified"),
        "sap": ("drake", "point, sap"),
        "lagged": ("drake", "point, lagged, stiction tolerance 0.01 mm/s"),
        "default lagged": ("drake", "point, lagged"),
        "impratio": ("mujoco", "implicitfast, elliptic, impratio 100"),
        "noslip": ("mujoco", "implicitfast, elliptic, impratio 100, noslip 10, solref 5 ms"),
        "MuJoCo": ("mujoco", "implicitfast, elliptic, impratio 100, solref 5 ms"),
    })  # fmt: skip

    def __missing__(self, name):
        scene, speed, engine, h = name.split(", ")
        engine, setting = self.ENGINES[engine]
        of = {"scene": scene, "speed": float(speed) / 1e3, "engine": engine}
        if h in ("holds", "right", "least"):
            own = {} if engine == "mujoco" else {"setting": setting}
            every = second_order(**of, **own)
            verdict = "holds" if h == "least" else h
            steps = [1e3 * row["h"] for row in every if row[verdict]]
            return min(steps) if h == "least" else max(steps)
        (row,) = second_order(**of, setting=setting, h=float(h) / 1e3)
        return (
            {"step": row["h"] * row["cost"]}
            | {key: row[key] for key in ("turn", "cost")}
            | {key: 1e3 * row[key] for key in ("way", "end_way", "depth", "creep")}
        )


def compared():
    return Compared()


def mjcf():
    """Largest differences from MuJoCo, of what both compute and of what it iterates [m, -]."""
    rows = table("mjcf.md")
    columns = ("masses", "poses", "Jacobians", "mass matrix", "spheres and capsules")
    return {
        "exact": max(float(row[column]) for row in rows for column in columns),
        "iterated": max(float(row["other shapes"]) for row in rows),
        "reach": re.search(r"mesh reaches: (\S+) m from", text("mjcf.md"))[1],
    }


class Spread(dict):
    """Least and most of a number over runs, such as "way; engine=drake; h=0.0001/0.0005"."""

    def __missing__(self, name):
        key, *fields = name.split("; ")
        kept = second_order()
        for field in fields:
            of, values = field.split("=")
            kept = [row for row in kept if str(row[of]) in values.split("/")]
        found = [row[key] for row in kept]
        least, most = min(found), max(found)
        return {"least": least, "most": most, "least, mm": 1e3 * least, "most, mm": 1e3 * most}


def spread():
    return Spread()


def ratios_to_ours():
    """Of each engine to ours, least and most: steps of the lift, by the verdict; cost if right."""
    ours, found = Compared.OURS, {}
    for verdict in ("holds", "right"):
        for engine in ("mujoco", "drake", "point, sap"):
            found[verdict, engine] = []
            for speed in STUDY["speeds"]:
                runs = [row for row in second_order(scene="lift", speed=speed) if row[verdict]]
                largest = max(row["h"] for row in runs if ours == (row["engine"], row["setting"]))
                theirs = max(row["h"] for row in runs if engine in (row["engine"], row["setting"]))
                found[verdict, engine].append(largest / theirs)
    for engine in ("mujoco", "drake"):
        found["cost", engine] = []
    for scene, speed in product(STUDY["scene"], STUDY["speeds"]):
        right = second_order(scene=scene, speed=speed, right=True)
        own = [row["cost"] for row in right if ours == (row["engine"], row["setting"])]
        for engine in ("mujoco", "drake") if own else ():
            cost = min(row["cost"] for row in right if row["engine"] == engine)
            found["cost", engine].append(cost / min(own))
    of = ("scene", "speed", "h")
    plain = {tuple(row[key] for key in of): row for row in second_order(setting="uncertified")}
    found["cost", "certified"] = [
        row["cost"] / plain[tuple(row[key] for key in of)]["cost"]
        for row in second_order(setting="certified")
    ]
    return {", ".join(name): {"least": min(own), "most": max(own)} for name, own in found.items()}


def needed_step():
    """The time step of the rule of thumb for the grasp [ms]."""
    return 1e3 * time_step_record(load_scenario("bunny_grasp"))["small_drag_from"]


def smoothed():
    """The error of a smoothed pinch, by the weight [N m s], relative to the free step."""
    step = pinch(grip=5.0, offset=0.02)
    hard = exact(step).delta_q
    errors = {w: error(step, barrier_step(step, float(w)).x, hard) for w in WEIGHTS}
    digits = zip(errors.values(), (1, 1, 2, 3, 4, 4, 4), strict=True)
    return " | ".join(f"{e:.{n}e}".replace("e-0", "e-") for e, n in digits)


def lifting():
    """The least step by (R46), h = m v / (4 N - m g) [ms], by the speed [mm/s]."""
    return {v: MASS * v / (4 - MASS * G) for v in (10, 30, 100, 300)}


def dials():
    """Median digits of contact-qp-2 with default settings, in the families that its page names."""
    families = table("../studies/default/summary.md", "By problem family")
    piqp = [float(row["native:piqp"]) for row in families]
    daqp = {name: families[name]["cvxpy:daqp"] for name in ("near_copies", "copies")}
    return daqp | {"least": min(piqp), "most": max(piqp)}


# -- Measured pushes ------------------------------------------------------------------------------
def reality():
    """What each pair came to."""
    return record("reality")["pairs"]


def certified():
    """Steps of each kind."""
    steps = record("reality")["steps"]
    bound = record("reality")["largest_error_bound"]
    return steps | {"all": sum(steps.values()), "bound": bound}


def ablations():
    return record("reality_ablations")["variants"]


def tripod():
    return record("reality_tripods")


def tripods():
    """The sets of the ellipsoid, with the median error over the median turn [%]."""
    return {name: own | {"share": 100 * own["median error over median turn"]}
            for name, own in tripod()["variants"]["ellipsoid"].items()}  # fmt: skip
