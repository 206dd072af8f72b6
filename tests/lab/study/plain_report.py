"""The numbers of a report again, from the rows, by plain loops; shares no code with it."""

import math
import re


def tables_of(markdown):
    """(title, filter, columns, rows) of every table of a page."""
    found = []
    title = None
    where = None
    lines = []
    for line in [*markdown.splitlines(), ""]:
        if head := re.fullmatch(r"\*\*(.*?)\*\* \*Rows:\* (.*)\.", line):
            title, where = head.groups()
        elif line.startswith("|"):
            lines.append([cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]])
        elif lines:
            found.append((title, where, lines[0], lines[2:]))
            lines = []
    return found


def rows_named(rows, words):
    """The rows that a filter names, `interface = cvxpy, warm = false; ...`."""
    kept = rows
    if words.startswith("all rows"):
        return kept
    for part in words.split(";")[0].split(", "):
        name, value = part.split(" = ")
        kept = [r for r in kept if entry(r, name) == value]
    return kept


def entry(row, name):
    if name == "label":
        return row["interface"] + ":" + row["solver"]
    value = row[name]
    return str(value).lower() if isinstance(value, bool) else str(value)


def shared_rows(rows, names):
    """Rows on the problems on which all, by `names`, were called; cat was on 9 of 12 only."""
    made = [r for r in rows if r["outcome"] != "not_run_budget"]
    on = {}
    for r in made:
        on.setdefault(tuple(entry(r, n) for n in names), set()).add((r["problem"], r["repetition"]))
    most = max(map(len, on.values())) if "label" in names else 0
    kept = {key: own for key, own in on.items() if len(own) >= 0.9 * most}
    every = set.intersection(*kept.values())
    return [r for r in made if tuple(entry(r, n) for n in names) in kept
            and (r["problem"], r["repetition"]) in every]  # fmt: skip


def quantile(values, share):
    """Linear between order statistics; 0.5 is the median."""
    ordered = sorted(values)
    at = share * (len(ordered) - 1)
    low = ordered[math.floor(at)]
    high = ordered[math.ceil(at)]
    return low + (at - math.floor(at)) * (high - low)


def digits_delivered(row, what="delta_q"):
    value = row["digits"][what]
    return value if row["outcome"] == "solved" and value is not None else 0.0


def seconds(row, limit):
    """Of the first call, on a copy of the problem."""
    return row["seconds"]["first"] if row["outcome"] == "solved" else limit


def number(column, rows, limit):
    """What stands in a column of that name, made of these rows; None for a column of text."""
    if narrowed := re.fullmatch(r"(.*), (\w+ = \w+)", column):
        return number(narrowed[1], rows_named(rows, narrowed[2]), limit)
    if least := re.match(r">= (\d+) digits", column):
        return 100 * sum(digits_delivered(r) >= float(least[1]) for r in rows) / len(rows)
    known = [r["iterations"] for r in rows if r["iterations"] is not None]
    times = [seconds(r, limit) for r in rows]
    logs = sum(math.log(t + 1e-3) for t in times) / len(times)
    counted = column.removesuffix(" (budget)").replace(" ", "_")
    counts = {
        "calls": len(rows),
        "problems": len({(r["problem"], r["repetition"]) for r in rows}),
        "solved [%]": 100 * sum(r["outcome"] == "solved" for r in rows) / len(rows),
        "digits, 1st percentile": quantile([digits_delivered(r) for r in rows], 0.01),
        "digits, median": quantile([digits_delivered(r) for r in rows], 0.5),
        "digits of the net wrench, median": quantile(
            [digits_delivered(r, "net_wrench") for r in rows], 0.5
        ),
        "time, median [ms]": 1e3 * quantile(times, 0.5),
        "time, shifted geometric mean [ms]": 1e3 * (math.exp(logs) - 1e-3),
        "iterations, median": quantile(known, 0.5) if known else None,
    }
    if column in counts:
        return counts[column]
    ended = {"not_run": "not_run_budget"}.get(counted, counted)
    return sum(r["outcome"] == ended for r in rows)


def agrees(cell, value):
    """Whether a cell shows a value, as far as it shows figures."""
    if value is None:
        return cell == "-"
    mantissa = cell.lower().partition("e")[0]
    decimals = len(mantissa.partition(".")[2])
    power = int(cell.lower().partition("e")[2] or 0)
    # Whole numbers of three figures may stand for more, as 123 ms does for 122.6 ms.
    return abs(float(cell) - value) <= 0.5001 * 10.0 ** (power - decimals)


def lines(tables, *, titled):
    """(title, filter, columns, line) of tables whose title begins so."""
    return [
        (title, where, columns, line)
        for title, where, columns, body in tables
        if re.match(titled, title)
        for line in body
    ]


def checked_count(tables, rows, limit):
    """How many numbers of tables of counts were compared, each of which is that of the rows."""
    count = 0
    titles = "Setting|Raw units|Cold|qpsolvers and cvxpy|Machines|How the calls"
    for title, where, columns, line in lines(tables, titled=titles):
        own = rows_of_line(where, columns, line, rows)
        for column, cell in zip(columns, line, strict=True):
            if column not in ("solver", "setting", "interface", "machine"):
                value = number(column, own, limit)
                assert agrees(cell, value), (title, line[0], column, cell, value)
                count += 1
    return count


def rows_of_line(where, columns, line, rows):
    """The rows that one line of a table is about."""
    kept = rows_named(rows, where)
    if "left out" in where:
        kept = [r for r in kept if r["outcome"] != "not_run_budget"]
    for name, cell in zip(columns, line, strict=True):
        if name == "solver":
            solver, _, machine = cell.partition("@")
            kept = [r for r in kept if solver in (entry(r, "label"), r["solver"])
                    and machine in ("", r.get("machine"))]  # fmt: skip
        elif name in ("setting", "interface", "machine"):
            kept = [r for r in kept if r[name] == cell]
    if both := re.search(r"at every value of (\w+)", where):
        kept = shared_rows(kept, [both[1]])
    return kept
