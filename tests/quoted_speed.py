"""The phrases of docs/speed.md, against the committed profile of a step and the benchmarks."""

from tests.quoted import cell, cells, said

PROFILE, BENCH = "validation/results/step_profile.md", "validation/results/benchmarks/bench.md"
LARGE, HEAP = "validation/results/large_steps.md", "5 x 5 x 4"
SHOWN = ("1", "3", "8", "16", "24", "32", "3 x 3 x 3", "4 x 4 x 3")
"""Boxes, in the table of docs/speed.md."""
PAPERS = 90
"""The paper's bound of its average step [us]."""
NAMES = {
    "DAQP, nothing certified, warm": "daqp", "PIQP, nothing certified": "piqp",
    "OSQP, nothing certified, warm": "osqp", "Clarabel, nothing certified": "clarabel",
    "Clarabel, certified": "clarabel certified",
}  # fmt: skip


def parts(which, backend, column):
    """A column of the profile, with the tracker and by brute force."""
    ways = ("tracker", "brute force")
    return [cell(PROFILE, which, f"{backend}, {way}", column) for way in ways]


def time(us):
    return f"{us:.0f} us" if us < 995 else f"{us / 1e3:.1f} ms"


def row(name, backend):
    step = map(time, parts("Medians", backend, "step"))
    solve, call = (parts("Medians", backend, c) for c in ("solve [%]", "call alone [%]"))
    words = " (with the certificate)" if "certified" in backend else ""
    shares = f"{solve[0]:.0f} %, {solve[1]:.0f} %{words} | {call[0]:.0f} %, {call[1]:.0f} %"
    return f"| {name} | {' | '.join(step)} | {shares} |"


def factors():
    """Means of steps, and how many times the paper's bound each is at least."""
    fastest, as_papers = parts("Means", "daqp", "step")
    proved = parts("Means", "clarabel certified", "step")[0]
    return (fastest, fastest / PAPERS, as_papers, as_papers / PAPERS,
            proved / 1e3, proved / PAPERS)  # fmt: skip


def promise(name):
    return cell(BENCH, "", name, "measured")


def distances():
    """Signed distances of a step: all of them, and those of the tracker in the mean."""
    return said(PROFILE, r"evaluates (\d+) signed distances, with the tracker (\d+) in the mean")


def sparse(boxes, backend, column):
    return cell(LARGE, "Sparse steps", (boxes, backend), column)


def of_ways(boxes):
    """A row of the table of dense and sparse steps, as the page has it."""
    ways = ("daqp dense", "piqp dense", "piqp sparse", "clarabel dense", "clarabel sparse")
    (row,) = (r for r in cells(LARGE, "Dense and sparse") if r["boxes"] == boxes)
    return f"| {boxes} | {row['entries of J']} | {' | '.join(row[way] for way in ways)} |"


def chains():
    boxes = ("10", "20", "40", "80", "160")
    times = [sparse(n, "piqp", "off [ms]") for n in boxes]
    found = [exponent(what, b) for what, b in BOTH]
    return ", ".join(f"{ms:.1f}" if ms < 9.95 else f"{ms:.0f}" for ms in times), *found


BOTH = (("bodies", "piqp"), ("bodies", "clarabel"), ("contacts", "piqp"), ("contacts", "clarabel"))


def exponent(what, backend):
    return cell(LARGE, "Promises", f"exponent in {what}, {backend}", "measured")


def heap():
    columns = ("first [ms]", "off [ms]", "off p99 [ms]", "residual [ms]")
    of_piqp = [sparse(HEAP, "piqp", c) for c in columns]
    size = [int(sparse(HEAP, "piqp", c)) for c in ("contacts", "coordinates", "rows")]
    return *size, *of_piqp, sparse(HEAP, "clarabel", "first [ms]")


def bounds():
    """The heap's cost of a bound [ms], and the largest bound of PIQP's answers."""
    rows = [r for r in cells(LARGE, "Sparse steps") if r["backend"] == "piqp"]
    assert {r["without bound"] for r in rows} == {"0"}
    assert {r["unsolved"] for r in rows} == {"0"}
    return [max(float(r["largest error bound"]) for r in rows)]


def clarabel_dense():
    """How many times as long Clarabel takes for a row of 8 boxes if its arrays are dense."""
    (row,) = (r for r in cells(LARGE, "Dense and sparse") if r["boxes"] == "8")
    return [float(row["clarabel dense"]) / float(row["clarabel sparse"])]


def held():
    """What docs/speed.md has to say."""
    return [
        *(row(*pair) for pair in NAMES.items()),
        "all {:,.0f}, in NumPy, or the tracker's".format(*distances()[:1]),
        "{:.0f} in the mean |".format(*distances()[1:]),
        "takes {:.0f} us in the mean, {:.1f} times 90 us; if it evaluates what the paper's does, "
        "{:.0f} us, {:.1f} times; Clarabel's, with a proof, {:.1f} ms, {:.0f} times".format(
            *factors()
        ),
        "all distances, {:.0f} us in NumPy,".format(*parts("Medians", "daqp", "distances")[1:]),
        "the solve is {:.0f} % with the tracker and {:.0f} % without".format(
            *parts("Means", "osqp", "solve [%]")
        ),
        *map(of_ways, SHOWN),
        "take about {} ms a step: the exponent in the number of bodies is {:.2f}, with Clarabel "
        "{:.2f}. With 16 boxes and 62 to 992 contacts the exponent in the number of contacts is "
        "{:.2f}, with Clarabel {:.2f}".format(*chains()),
        "5 x 5 x 4 boxes, {:,} contacts, {} coordinates, {:,} rows: {:.0f} ms at first with PIQP, "
        "{:.0f} ms over 100 steps (99th percentile {:.0f}), {:.0f} ms with the bound; {:.0f} ms at "
        "first with Clarabel".format(*heap()),
        "at most {:.1e} in all of these scenes with PIQP".format(*bounds()),
        "Clarabel takes {:.1f} times as long for a row of 8 boxes if its arrays are dense".format(
            *clarabel_dense()
        ),
        "Whole they take {:.1f} MB each for 100 free bodies, {:.0f} MB each for 300".format(
            *[8e-6 * (6 * bodies) ** 2 for bodies in (100, 300)]
        ),
        f"13 x 80 step takes {promise('step over the bare solver'):.1f} times the bare DAQP call",
        f"through CVXPY takes {promise('through CVXPY over native'):.1f} times as long",
        f"**Compiled**, a step takes {promise('compiled step [us]'):.0f} us, "
        "less than the paper's 90 us on another machine, and "
        f"{promise('compiled step, certified [us]'):.0f} us with its proof",
        f"The step takes {promise('compiled step over the bare solver'):.1f} times the bare call; "
        "the target is 4",
        "Of the 250 proved steps of `bench` the slowest three take "
        f"{promise('compiled step, certified, 99th percentile [us]'):.0f} us or more",
        "takes {:.0f} us with PIQP and {:.0f} us with Clarabel".format(
            *said(BENCH, r"takes (\d+) us with piqp .* and (\d+) us with clarabel")
        ),
    ]
