"""docs/solver_study.md against the committed rows: each number on the page is computed from them.

Each phrase with braces has a question whose answers fill them. When the rows are made again, the
test lists the phrases as they ought to read; whether what the page concludes from them still
holds is for a reader. The first table of the page is held by test_committed_studies.py.
"""

import json
import math
import re
import tomllib

import numpy as np

from quasistatic_ref.lab.study.columns import chosen, size
from tests.quoted import filled, stale, unheld, word
from tests.study import committed_rows as of
from tests.study.committed_rows import (
    SETTINGS,
    asked,
    by_interface,
    by_start,
    columns,
    directly,
    false_share,
    median,
    median_raw_and_natural,
    missed,
    other_digits,
    other_shares,
    overhead,
    raw_and_natural,
    share,
    shared,
    shares_by_interface,
    time,
    unsolved,
    warm_iterations,
)

VALIDATION = of.DEFAULT.parents[1]
PAGE = of.DEFAULT.parents[2] / "docs" / "solver_study.md"
CONSTANTS = re.compile(
    r"1e-\d+|\d digits|by 1 %|at most 40|200 problems|all 200|limit of 1 s|sqrt\(2 eps\)|up to 1e9"
)
"""What the page says that is no result: accuracies, digits that count, how much was measured."""


def extent():
    count = of.study()["problems"]["count"]
    interfaces = [
        len(set(chosen(columns(), {"interface": r})["solver"])) for r in ("qpsolvers", "cvxpy")
    ]
    names = (len(set(columns()[name])) for name in ("setting", "units"))
    return (
        f"{count:,}",
        of.enclosed(),
        *(word(n) for n in (*interfaces, *names)),
        f"{size(columns()):,}",
    )


def small_daqp():
    part, own = shared("daqp", "tuned"), asked("daqp", "default")
    wrong = chosen(own, {"wrong": True})
    heavy = size(chosen(wrong, {"family": "mass_ratio"}))
    at_least = [int((part["digits"] >= least).sum()) for least in (6, 9)]
    lost = int((wrong["digits"] < 3).sum())
    assert lost == size(wrong)
    return at_least[0], size(part), at_least[1], float(time(part)), lost, f"{size(own):,}", heavy


def piqp():
    part = asked("piqp", "high")
    seconds = float(np.median(part["seconds"]))
    return share(part), f"{size(part):,}", word(int(part["wrong"].sum())), 1e3 * seconds


def scs_to_piqp():
    ours, theirs = asked("scs", "high"), asked("piqp", "high")
    return share(ours), float(np.median(ours["seconds"]) / np.median(theirs["seconds"]))


def lost_by_piqp():
    """Problems without 6 digits at its tightest, all of which it says it did not solve."""
    part = shared("piqp", "tuned")
    lost = part["digits"] < 6.0
    assert not part["solved"][lost].any()
    return int(lost.sum())


def highs_medians():
    """The median at every setting, which is one number only if all are the same."""
    return "/".join(sorted({median(shared("highs", setting)) for setting in SETTINGS}))


def honest(solver):
    heavy, all_ = missed(solver, "mass_ratio")
    assert all_ == int((~asked(solver, "high")["solved"]).sum())  # none is an answer that is wrong
    return unsolved(asked(solver, "high")), heavy, all_


def false_claims():
    claims = [f"{int(columns()[name].sum()):,}" for name in ("said_optimal", "wrong")]
    high = chosen(directly(), {"setting": "high"})
    own = [int(asked(solver, "high")["wrong"].sum()) for solver in ("highs", "qpalm")]
    assert sum(own) == high["wrong"].sum()
    return *claims, int(high["wrong"].sum()), f"{int(high['said_optimal'].sum()):,}", *own


def infeasible_claims():
    said = columns()["said_infeasible"]
    assert (columns()["false_infeasible"] == said).all()
    proxqp = int((said & (columns()["solver"] == "proxqp")).sum())
    return int(said.sum()), proxqp, int(said.sum()) - proxqp


def osqp_iterations():
    found = warm_iterations("osqp")
    same = [setting for setting, (cold, warm) in found.items() if cold == warm]
    assert set(SETTINGS) - set(same) == {"high"}
    return word(len(same)), word(len(found)), *found["high"]


def ending():
    late = chosen(columns(), {"outcome": "timeout"})
    return size(late), size(chosen(late, {"solver": "proxqp"}))


def budgets():
    spent = of.spent()
    own = [spent[f"{interface}:proxqp"] for interface in ("qpsolvers", "cvxpy")]
    others = (seconds for label, seconds in spent.items() if not label.endswith(":proxqp"))
    return own[0], of.study()["budget"], own[1], math.ceil(max(others))


HELD = [
    ("{} contact problems whose answers are known (exactly but for {}), {} solvers directly and {} "
     "of them through CVXPY too, {} settings, {} systems of units, {} calls", extent),
    ("Soonest first; {} problems of all families", lambda: [size(shared("daqp", "tuned"))]),
    ("delivers 6 digits on {} of the {} problems and 9 digits on {}, in {:.3f} ms. Do not leave "
     "it at its defaults: at its own `primal_tol=1e-6`, {} of {} answers have fewer than 3 digits "
     "and say optimal, {} of them of the family of mass ratios", small_daqp),
    ("delivers 6 digits on {} % of all {:,}.",
     lambda: [share(asked("quadprog", "default")), size(asked("quadprog", "default"))]),
    ("delivers 6 digits on {} % of all {}, makes {} false claim, and takes {:.2f} ms", piqp),
    ("SCS, an operator-splitting method, is surer at `eps_abs=1e-9, eps_rel=0` ({} %) and takes "
     "{:.1f} times as long", scs_to_piqp),
    ("Of the {} problems that is {} %, and {} % at the options of the table, where the other {} "
     "are not solved",
     lambda: [size(shared("piqp", "high")),
              *(share(shared("piqp", s)) for s in ("high", "tuned")), lost_by_piqp()]),
    ("Of the {} problems it delivers 6 digits on {} % at 1e-9 throughout, and on {} %",
     lambda: [size(shared("clarabel", "high")),
              *(share(shared("clarabel", s)) for s in ("high", "tuned"))]),
    ("Of their claims of success {} % (OSQP), {} % (ProxQP) and {} % (QPALM) are false, as are "
     "{} % of SCS's", lambda: [false_share(s) for s in ("osqp", "proxqp", "qpalm", "scs")]),
    ("{} and {} of their claims are false",
     lambda: [", ".join(str(asked(s, "high")["wrong"].sum()) for s in ("osqp", "proxqp")),
              asked("qpalm", "high")["wrong"].sum()]),
    ("OSQP solves all but {} % of the problems ({} of these {} are mass ratios)",
     lambda: honest("osqp")),
    ("ProxQP all but {} % ({} of {})", lambda: honest("proxqp")),
    ("of which it calls {} infeasible",
     lambda: [asked("proxqp", "high")["false_infeasible"].sum()]),
    ("Of {} claims that there is no solution all are false: {} of ProxQP's, {} of others",
     infeasible_claims),
    ("HiGHS has {} digits in the median at each of the {} settings",
     lambda: [highs_medians(), word(len(SETTINGS))]),
    ("it solves {:.1f} % at its defaults and {:.1f} % at 1e-9",
     lambda: [100 * asked("highs", s)["solved"].mean() for s in ("default", "high")]),
    ("share of {} problems with 6 digits", lambda: [size(shared("daqp", "default", "raw"))]),
    ("PIQP tuned {} against {} %", lambda: raw_and_natural("piqp", "tuned")),
    ("SCS tuned {} against {} %", lambda: raw_and_natural("scs", "tuned")),
    ("ProxQP tuned {} against {} %", lambda: raw_and_natural("proxqp", "tuned")),
    ("in the median PIQP has {} in raw and {} in natural units, SCS {} and {}, ProxQP {} and {}",
     lambda: [d for s in ("piqp", "scs", "proxqp") for d in median_raw_and_natural(s)]),
    ("Of {} claims of success {} are false. Natural units and 1e-9, called directly and cold, "
     "leave {} of {}: {} of HiGHS and {} of QPALM", false_claims),
    ("an error of sqrt(2 eps), {:.0f} digits for 1e-6", lambda: [-math.log10(math.sqrt(2e-6))]),
    ("PIQP delivers {} digits in the median and Clarabel {}, but 6 digits on {} and {} % of the "
     "{} problems only; at 1e-9 the shares are {} and {} %",
     lambda: [*(f(shared(s, "mid")) for f in (median, share) for s in ("piqp", "clarabel")),
              size(shared("piqp", "mid")),
              *(share(shared(s, "high")) for s in ("piqp", "clarabel"))]),
    ("Clarabel takes {:.2f} ms at the options of the table and {:.2f} ms at 1e-6",
     lambda: [1e3 * np.median(shared("clarabel", s)["seconds"]) for s in ("tuned", "mid")]),
    ("{} of {} for Clarabel, {} of {} for ProxQP, {} of {} for OSQP, {} of {} for QPALM, "
     "{} of {} for SCS and {} of {} for DAQP",
     lambda: [n for s in ("clarabel", "proxqp", "osqp", "qpalm", "scs", "daqp")
              for n in missed(s, "mass_ratio")]),
    ("PIQP ({} of {}; {} more are steps of the bunny's grasp",
     lambda: [*missed("piqp", "mass_ratio"),
              missed("piqp", "bunny_grasp", "closest_points", begins="time_step/bunny_grasp")[0]]),
    ("HiGHS ({} of {}; {} more are steps of `allegro_turn` and `door`",
     lambda: [*missed("highs", "mass_ratio"), missed("highs", "allegro_turn", "door")[0]]),
    ("CVXPY costs {:.1f} to {:.1f} ms a call", overhead),
    ("OSQP at its defaults delivers 6 digits on {} % of {} problems directly and on {} % through "
     "CVXPY, QPALM on {} and {} %",
     lambda: [(own := shares_by_interface("osqp", "default"))[0],
              size(by_interface("osqp", "default")[0]), own[1],
              *shares_by_interface("qpalm", "default")]),
    ("for ProxQP alone ({} to {} % at 1e-9)", lambda: shares_by_interface("proxqp", "high")),
    ("{} of {} problems of PIQP tuned", lambda: other_digits()["piqp", "tuned"]),
    ("DAQP, tuned, goes from {:.3f} to {:.3f} ms",
     lambda: [1e3 * np.median(p["seconds"]) for p in by_start("daqp", "tuned")]),
    ("those of OSQP at {} of {} ({:.0f} to {:.0f} at 1e-9)", osqp_iterations),
    ("ProxQP takes up to {:.0f} more",
     lambda: [max(warm - cold for cold, warm in warm_iterations("proxqp").values())]),
    ("took {:.0f} s with the starts", lambda: [sum(of.spent().values())]),
    ("ProxQP took {:.0f} s of its budget of {:.0f} s directly and {:.0f} s through CVXPY, no "
     "other solver more than {} s", budgets),
    ("cut off ({} here, {} of them ProxQP's)", ending),
]  # fmt: skip


def test_every_number_of_the_page_is_that_of_the_committed_rows():
    page = PAGE.read_text("utf-8")
    phrases = filled(HELD)
    wrong = stale(page, phrases)
    assert not wrong, "ought to read:\n" + "\n".join(wrong)
    assert unheld(page, phrases, CONSTANTS) == []


def test_what_is_known_of_highs_is_that_of_the_committed_rows():
    """In docs/studies.md."""
    grasp = chosen(asked("highs", "default"), {"family": "bunny_grasp"})
    every = of.of_solver("highs")
    phrases = [
        f"{grasp['solved'].sum()} of {size(grasp)} of `bunny_grasp` at its defaults.",
        f"None of its {size(every):,} calls in the committed study met the time limit",
    ]
    assert stale(PAGE.with_name("studies.md").read_text("utf-8"), phrases) == []
    assert "timeout" not in every["outcome"]


def test_the_table_of_units_is_that_of_the_committed_rows():
    line = re.compile(r"^\| (\w+) \| (\w+) \| ([\d.]+) \| ([\d.]+) \|$", re.MULTILINE)
    lines = line.findall(PAGE.read_text("utf-8"))
    assert len(lines) == 7
    assert [line[2:] for line in lines] == [
        tuple(raw_and_natural(solver.lower(), setting)) for solver, setting, *_ in lines
    ]


def finding_lines():
    """A line of the table for each single change that the file of options names."""
    spaces = tomllib.loads((VALIDATION / "option_search.toml").read_text("utf-8"))
    text = (VALIDATION / "results" / "option_search.jsonl").read_text("utf-8")
    every = [one for one in map(json.loads, text.splitlines()) if one["half"] == "all"]
    names = {"highs": "HiGHS", "osqp": "OSQP", "proxqp": "ProxQP"}
    for solver, space in spaces.items():
        for finding in space["findings"]:
            base, new = (
                next(o for o in every if (o["solver"], o["options"]) == (solver, options))
                for options in (finding["base"], finding["base"] | finding["change"])
            )
            start = "its defaults" if not finding["base"] else f"{finding['base']['eps_abs']:g}"
            change = ", ".join(f"`{k}={v}`" for k, v in finding["change"].items())
            cells = [f"{base[n]:.1f} to {new[n]:.1f}" for n in ("six", "nine", "median")]
            cells.append(f"{base['false_infeasible']} to {new['false_infeasible']}")
            yield f"| {names[solver]} | {start} | {change} | {' | '.join(cells)} |"


def test_the_table_of_single_options_is_that_of_the_committed_log():
    page = PAGE.read_text("utf-8")
    missing = [line for line in finding_lines() if line not in page]
    assert not missing, "ought to read:\n" + "\n".join(missing)


def test_what_the_page_concludes_without_a_number_is_so():
    assert other_shares() == [("proxqp", "high")]
    proxqp = {("proxqp", "high"), ("proxqp", "tuned")}
    assert set(other_digits()) == {("osqp", "high"), ("piqp", "tuned")} | proxqp
    for solver in ("scs", "qpalm"):
        assert all(cold == warm for cold, warm in warm_iterations(solver).values())
    for solver in (
        "osqp",
        "proxqp",
        "qpalm",
        "scs",
    ):  # a false claim at a default has fewer than 3 digits
        assert (chosen(asked(solver, "default"), {"wrong": True})["digits"] < 3).all()
