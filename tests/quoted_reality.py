"""Numbers of docs/reality.md, from the committed results of measured pushes."""

import json
from functools import cache

import numpy as np

from tests.quoted import ROOT


@cache
def result(name):
    return json.loads((ROOT / "validation" / "results" / f"{name}.json").read_text("utf-8"))


def pooled(key, part="mean"):
    """(mm, degrees) of the mean over pairs."""
    return result("reality")["pairs"]["all"][key][part]


def between_pairs():
    """Student's 95 % intervals of the mean difference over pairs: mm, degrees."""
    pairs = [entry for name, entry in result("reality")["pairs"].items() if name != "all"]
    mean = np.array([pair["more"]["mean"] for pair in pairs])
    half = STUDENT_17 * mean.std(axis=0, ddof=1) / np.sqrt(len(pairs))
    assert len(pairs) == 17 + 1
    return np.ravel([mean.mean(axis=0) - half, mean.mean(axis=0) + half], order="F")


STUDENT_17 = 2.1098
"""The 97.5 % quantile of Student's distribution with 17 degrees of freedom."""


def ratios(key="ratio"):
    """What was identified in the ellipsoid, by pair [mm]."""
    cones = {name: entry["cones"]["ellipsoid"] for name, entry in identified().items()}
    return {name: 1e3 * entry[key] for name, entry in cones.items()}


def identified():
    return result("reality_identified")


def lost(cone):
    """The mean lost share of dissipation [%]."""
    return 100 * np.mean([entry["cones"][cone]["misfit"] for entry in identified().values()])


def variant(name):
    """Mean error (mm, degrees) of a variant."""
    return result("reality_ablations")["variants"][name]["error"]["mean"]


def farthest(*names):
    """Largest change of the mean error of some variants, (mm, degrees)."""
    own = np.array(variant("ellipsoid"))
    return np.abs([np.array(variant(name)) - own for name in names]).max(0)


def ties(key):
    return result("reality_ablations")["spread over the pyramid's ties"][key]


def tripods(variant="ellipsoid"):
    """Median error over median turn of the sets that calibrated nothing [%]."""
    sets = result("reality_tripods")["variants"][variant]
    return [100 * entry["median error over median turn"] for entry in list(sets.values())[1:]]


def pyramids():
    shares = [s for name in result("reality_tripods")["variants"] if name.startswith("pyramid")
              for s in tripods(name)]  # fmt: skip
    return [min(shares), max(shares)]


def unidentified(*cones):
    return [sum(not entry["cones"][cone]["identifiable"] for entry in identified().values())
            for cone in cones]  # fmt: skip


CANCEL = ("mass 10 kg", "h 0.2 s", "mu_v 0.6", "gyration 20 mm", "finger's stiffness 1e5 N/m")


def tie_breaks():
    return [name for name in result("reality_ablations")["variants"] if "tie broken" in name]


def identified_row(name):
    entry = identified()[name]
    own = entry["cones"]["ellipsoid"]
    mm = [1e3 * x for x in (own["ratio"], own["low"], own["high"], own["reverse"],
                            entry["published"], entry["uniform"])]  # fmt: skip
    row = "| {} | {} | **{:.1f}** | {:.1f} - {:.1f} | {:.1f} | {:.1f} | {:.1f} | {:.2f} | {:.3f} |"
    return row.format(name, own["count"], *mm, own["friction"], own["friction"] * own["ratio"])


def error_row(name):
    entry = result("reality")["pairs"][name]
    error, cells = entry["error"], []
    for k in (0, 1):
        cells.append("**{:.2f}** ({:.2f} - {:.2f})".format(*(error[x][k] for x in ENDS)))
    moved, other = entry["moved"]["mean"], entry["published"]["mean"]
    label = "mean over pairs" if name == "all" else name
    return (f"| {label} | {entry['pushes']:,} | {moved[0]:.1f} | {moved[1]:.1f} | {cells[0]} | "
            f"{cells[1]} | {other[0]:.2f} | {other[1]:.2f} |")  # fmt: skip


ENDS = ("mean", "low", "high")


def ablation_row(name):
    entry = result("reality_ablations")["variants"][name]["error"]
    cells = ["{:.2f} ({:.2f} - {:.2f})".format(*(entry[x][k] for x in ENDS)) for k in (0, 1)]
    return f"| {name} | {cells[0]} | {cells[1]} |"


def tripod_row(name):
    own = result("reality_tripods")["variants"]["ellipsoid"][name]
    return "| {} | {} | {:.1f} | {:.2f} ({:.2f} - {:.2f}) | {:.0f} | {:.1f} | {:.2f} |".format(
        name, own["pushes"], own["median motion [deg]"], *own["median error [deg]"],
        100 * own["median error over median turn"], own["median motion [mm]"],
        own["median error [mm]"][0],
    )  # fmt: skip


def held():
    """What docs/reality.md has to say: phrases, and rows of its tables."""
    return [
        "**{:.2f} mm and {:.2f} degrees** (95 %: {:.2f} to {:.2f} mm, {:.2f} to {:.2f} degrees) "
        "where objects moved by {:.1f} mm and {:.1f} degrees".format(
            *pooled("error"),
            pooled("error", "low")[0],
            pooled("error", "high")[0],
            pooled("error", "low")[1],
            pooled("error", "high")[1],
            *pooled("moved"),
        ),
        "The published simulator, made for these pushes, has a fitted 3 x 3 matrix for each pair "
        "and is off by {:.2f} mm and {:.2f} degrees".format(*pooled("published")),
        "The difference from the published simulator, push by push, is {:+.2f} mm ({:+.2f} to "
        "{:+.2f}) and {:+.2f} degrees ({:+.2f} to {:+.2f})".format(
            *[pooled("more", part)[k] for k in (0, 1) for part in ENDS]
        ),
        "{:+.2f} to {:+.2f} mm and {:+.2f} to {:+.2f} degrees: our positions".format(
            *between_pairs()
        ),
        f"All {result('reality')['pairs']['all']['pushes']:,} pushes were run, in "
        f"{sum((s := result('reality')['steps']).values()):,} steps, of which {s['enclosure']:,} "
        f"are enclosed, {s['exact']:,} exact and none is unproved",
        f"the largest bound of an error is {result('reality')['largest_error_bound']:.0e}",
        f"between {min(ratios().values()):.1f} and {max(ratios().values()):.1f} mm",
        "the ellipsoid loses {:.1f} % of the dissipation, the bicone over a polygon of 16 sides "
        "{:.1f} %, of 8 sides {:.1f} %, the pyramid {:.1f} % and the product {:.1f} %".format(
            *[lost(c) for c in ("ellipsoid", "facets-16", "facets-8", "pyramid", "product")]
        ),
        "at the best angle of its axes for each pair "
        f"{100 * np.mean([entry['pyramid, best axes'] for entry in identified().values()]):.1f} %",
        "are not identifiable for {} pairs in the pyramid, {} in facets-8 and {} "
        "in facets-16".format(*unidentified("pyramid", "facets-8", "facets-16")),
        "the pyramid is off by {:.1f} to {:.1f} mm and {:.1f} to {:.1f} degrees".format(
            *[
                f([variant(f"pyramid, axes at {a} degrees")[k] for a in ("0", "22.5", "45")])
                for k in (0, 1)
                for f in (min, max)
            ]
        ),
        "the ellipsoid by {:.1f} mm and {:.1f} degrees".format(*variant("ellipsoid")),
        "less than {:.2f} mm and {:.2f} degrees".format(*farthest(*CANCEL) + 0.005),
        "{:.2f} mm and {:.2f} degrees".format(*farthest("steps of 0.5 mm")),
        "{:.2f} mm and {:.2f} degrees".format(
            *np.abs(
                [
                    np.array(variant(name)) - variant("pyramid, axes at 0 degrees")
                    for name in tie_breaks()
                ]
            ).max(0)
        ),
        f"{ties('95th percentile [mm]'):.1f} mm and {ties('95th percentile [deg]'):.1f} degrees",
        "facets-16 is off by {:.1f} mm and {:.1f} degrees, with the ratio identified for it by "
        "{:.1f} mm and {:.1f} degrees".format(
            *variant("facets-16"), *variant("facets-16, ratio identified for it")
        ),
        "predictions are off by {:.1f} mm and {:.1f} degrees, with half of it by {:.1f} mm and "
        "{:.1f} degrees".format(*variant("no torsion"), *variant("half of the torsion")),
        "With 0.15 in its place predictions are off by {:.2f} mm and {:.2f} degrees, with 0.35 by "
        "{:.2f} mm and {:.2f} degrees, with the fitted values by {:.2f} mm and "
        "{:.2f} degrees".format(
            *[
                x
                for value in ("0.15", "0.35", "fitted")
                for x in variant(f"finger's friction {value}")
            ]
        ),
        "with the published ratios in place of ours by {:.2f} mm and {:.2f} degrees, with the "
        "reverse ones by {:.2f} mm and {:.2f} degrees".format(
            *variant("ratio published"), *variant("ratio reverse")
        ),
        "{:+.2f} degrees ({:+.2f} to {:+.2f}) with 9 points, {:+.2f} ({:+.2f} to {:+.2f}) with 25 "
        "and {:+.2f} ({:+.2f} to {:+.2f}) with 100".format(
            *[
                result("reality_ablations")["variants"][f"{n} points"]["more"][end][1]
                for n in (9, 25, 100)
                for end in ENDS
            ]
        ),
        "9 points are off by {:.2f} mm and {:.2f} degrees, 25 points by {:.2f} mm and {:.2f} "
        "degrees, 100 points by {:.2f} mm and {:.2f} degrees, the patch by {:.2f} mm and {:.2f} "
        "degrees".format(
            *[
                x
                for name in ("9 points", "25 points", "100 points", "ellipsoid")
                for x in variant(name)
            ]
        ),
        f"{min(tripods()):.0f} to {max(tripods()):.0f} % of the median turn",
        "With the pyramid it is {:.0f} to {:.0f} %".format(*pyramids()),
        f"with 16 facets {min(tripods('facets-16')):.0f} to {max(tripods('facets-16')):.0f} %",
        "({:.2f}, {:.2f}) mm, {:.2f} degrees and a radius of {:.2f} mm".format(
            *(t := result("reality_tripods"))["offset [mm]"], t["angle [deg]"], t["radius [mm]"]
        ),
        *map(identified_row, identified()),
        *map(error_row, result("reality")["pairs"]),
        *map(ablation_row, result("reality_ablations")["variants"]),
        *map(tripod_row, result("reality_tripods")["variants"]["ellipsoid"]),
    ]
