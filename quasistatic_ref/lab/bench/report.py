"""The benchmark as a page of tables."""

from collections.abc import Mapping, Sequence
from typing import Any

from quasistatic_ref.lab.bench.acceptance import PAPER
from quasistatic_ref.lab.bench.derived import SCENE, STEP
from quasistatic_ref.lab.bench.grasp import PLAIN
from quasistatic_ref.lab.bench.solids import COLUMNS
from quasistatic_ref.lab.bench.whole_run import WALL
from quasistatic_ref.lab.page.markdown import markdown_table
from quasistatic_ref.solve.backends import CERTIFY

Rows = list[tuple[str, ...]]

SOLIDS = """Cubes of 40 mm lie apart on a floor, which each touches at four corners. At rest many
numbers of a step are exactly zero, and so are they where a push along x sticks or slides; askew is
a push along no axis, which slides. Friction holds half of a cube's weight; cubes that stick are
pushed with a fifth of it, those that slide with 0.7 of it. Three finger tips turn the drum. The
boxes in the bin have random sizes, were dropped, and are at rest. With `fast`, by what a step
certifies; `first`: the first proved step of a new simulator, which the plain path does not compare;
and on the plain path. MuJoCo's is `mj_step` of the same scene, from rest each time: with the
velocities of the step before, cubes that slide leave the floor after ten steps
(`pip install "quasistatic-ref[engines]"`)."""

VERDICTS = {True: "holds", False: "FAILS", None: "not judged"}


def promise_rows(promises: Sequence[Mapping[str, Any]]) -> Rows:
    """What was promised, measured, and whether it holds."""
    rows: Rows = [("promise", "measured", "limit", "verdict")]
    for p in promises:
        limit = f"at most {p['limit']:g}"
        rows.append((p["what"], f"{p['measured']:.3g}", limit, VERDICTS[p["holds"]]))
    return rows


def paper_sentence(tables: Mapping[str, Any]) -> str:
    """How far the step is from the paper's time."""
    m = tables["machine"]
    grasp = tables["grasp"]
    plain = tables["certification"][PLAIN]
    return (
        f"the paper's step takes less than {PAPER:g} us (its own interior-point method, all "
        f"distances, Julia 1.9.2 on a Mac M1 Pro). On {m['processor']}, with tracked distances and "
        "DAQP, which starts from the last answer, nothing certified, the 13 x 80 step takes "
        f"{grasp['step']:.0f} us, or {grasp['certified']:.0f} us with its proof; on the plain "
        f"path, with its proof, {plain:.0f} us"
    )


def page(tables: Mapping[str, Any]) -> str:
    """The tables in Markdown."""
    m = tables["machine"]
    promises = promise_rows(tables["promises"])
    lines = [
        "# What a step costs",
        "",
        "Written by `quasistatic-ref bench`; the numbers are those of one machine "
        f"({m['processor']}, {m['cores']} cores, {m['system']}, Python {m['python']}, "
        f"NumPy {m['numpy']}, {m['load']}), medians of the least times of each step, taken in "
        "turn in one process with what it is compared with. Nothing is certified unless it says "
        "so, records are light.",
        "",
        f"In short: {paper_sentence(tables)}.",
        "",
        *markdown_table(promises[0], promises[1:]),
        *_section(
            "With a certificate, fast; and on the plain path [us]",
            _over(tables["certification"], CERTIFY[0]),
        ),
        *_section(
            "300 steps of the grasp with all that a run does",
            _over(tables["run"], WALL, "least [us]"),
        ),
        *_section(f"Derivatives of a step of {SCENE}", _over(tables["derivatives"], STEP)),
        *_section("Scenes of solids [us]", _solids(tables["solids"])),
        *_section("Many bodies [us]", _solids(tables["large"])),
        "",
        SOLIDS,
    ]
    return "\n".join(lines) + "\n"


def _over(times: Mapping[str, float], base: str, what: str = "median [us]") -> Rows:
    """Times, and how many times that of the row `base` each is."""
    rows: Rows = [("what", what, f"over {base}")]
    rows += [(name, f"{us:.1f}", f"{us / times[base]:.2f}") for name, us in times.items()]
    return rows


def _solids(scenes: Mapping[str, Mapping[str, float]]) -> Rows:
    """What a step of each scene takes, and over what; columns of what was measured."""
    each = [*scenes.values()]
    columns = [key for key in COLUMNS if any(key in costs for costs in each)]
    ratios = {
        "over_solver": "off over DAQP",
        "over_mujoco": "off over MuJoCo",
        "proved_over_off": "full over off",
        "first_over_later": "first over full",
    }
    ratios = {key: name for key, name in ratios.items() if any(key in costs for costs in each)}
    rows: Rows = [("scene", *columns, *ratios.values())]
    for name, costs in scenes.items():
        us = (f"{costs[key]:.0f}" for key in columns)
        over = (f"{costs[key]:.2f}" for key in ratios)
        rows.append((name, *us, *over))
    return rows


def _section(title: str, rows: Rows) -> list[str]:
    return ["", f"## {title}", "", *markdown_table(rows[0], rows[1:])]
