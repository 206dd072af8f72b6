"""The report: each number of it is made again from the rows that it names, by plain loops."""

import re
import sqlite3
from contextlib import closing
from html import unescape
from zlib import crc32

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.figures.study import profile
from quasistatic_ref.lab.page.html import html_page, sorting_script
from quasistatic_ref.lab.page.markdown import markdown_page
from quasistatic_ref.lab.page.parts import Code, Report, Section, Table
from quasistatic_ref.lab.study.report.comparison import noise_of
from quasistatic_ref.lab.study.report.report import study_report
from quasistatic_ref.lab.study.report.rows import rows_of
from quasistatic_ref.lab.study.report.statistics import (
    interval,
    performance_ratios,
    resampled_means,
)
from quasistatic_ref.lab.study.store.store import Store, contents
from quasistatic_ref.lab.sweep import TABLE
from tests.lab.study import made_store, plain_report
from tests.lab.study.plain_report import agrees, digits_delivered, quantile, rows_named


def test_every_number_of_a_column_of_counts_is_that_of_the_rows(tables, rows):
    assert plain_report.checked_count(tables, rows, made_store.LIMIT) > 150


@pytest.fixture(scope="module")
def mixed(store, tmp_path_factory):
    """The folder of the same store, but for two of its twelve problems, which have no solution."""
    found = contents(store)
    for row in found.rows:
        if row["problem"] in ("stack/4/0", "door/5/0"):
            beyond = row["said_optimal"] and row["setting"] == "mid"
            none = dict.fromkeys(row["digits"])
            row |= {"feasible": False, "digits": none, "wrong": beyond, "wrong_multipliers": False}
    folder = tmp_path_factory.mktemp("mixed")
    with Store(folder, found.study, found.problems) as changed:
        changed.add(*found.rows)
    return folder


def claim_counts(rows):
    """Claims by kind, by plain loops."""
    kinds = dict.fromkeys(
        ["rows", "multipliers", "no numbers", "no solution", "kept, no solution", "infeasible"], 0
    )
    for row in rows:
        if row["said_optimal"] and not row["feasible"]:
            kinds["no solution" if row["wrong"] else "kept, no solution"] += 1
        elif row["said_optimal"]:
            kinds["no numbers"] += row["outcome"] == "nan"
            kinds["multipliers"] += row["wrong_multipliers"]
            alone = not row["wrong_multipliers"] and row["outcome"] != "nan"
            kinds["rows"] += row["wrong"] and alone
        elif row["said_infeasible"]:
            kinds["infeasible"] += row["wrong"]
    return [str(count) for count in kinds.values()]


def test_false_claims_are_those_of_the_rows(tables, rows):
    found = plain_report.lines(tables, titled="Claims, ")
    assert len(found) == 16
    for _, where, columns, (solver, *cells) in found:
        for setting, cell in zip(columns[1:], cells, strict=True):
            own = rows_named(rows, f"{where}, label = {solver}, setting = {setting}")
            said = sum(row["said_optimal"] for row in own)
            assert cell == f"{' + '.join(claim_counts(own))} / {said}"


def test_the_first_screen_counts_every_solver_on_every_problem(mixed):
    """Its claims are of all problems, its digits and times of half of those with a solution."""
    rows = [row for row in contents(mixed).rows if row["repetition"] == 0]
    tables = plain_report.tables_of(markdown_page(study_report(mixed)))
    (_, where, columns, body), *_ = tables
    shown = {line[0]: dict(zip(columns, line, strict=True)) for line in body}
    assert sorted(shown) == ["ant", "bee", "cat"]
    settings = {(line[0], line[1]): line[2] for table in tables if "its own options" in table[2]
                for line in table[3]}  # fmt: skip
    for name, line in shown.items():
        words = f"label = {line['interface']}:{name}"
        words += f", setting = {settings[name, line['interface']]}"
        every = rows_named(rows, f"{where.split(';')[0]}, {words}")
        called = [row for row in every if row["outcome"] != "not_run_budget"]
        assert [line[c] for c in columns if c.startswith(("false", "kept"))] == claim_counts(called)
        failed = [row for row in called if row["feasible"] and not row["said_optimal"]]
        missed = len(every) - len(called)
        assert [line["failures"], line["calls not made"]] == [str(len(failed)), str(missed)]
        possible = [row for row in called if row["feasible"]]
        half = [r for r in possible if crc32(r["problem"].rpartition("/")[0].encode()) % 2]
        for least in (3, 6):
            cell = next(line[c] for c in columns if c.startswith(f">= {least} digits"))
            share = 100 * sum(digits_delivered(row) >= least for row in half) / len(half)
            assert agrees(cell.split(" (")[0], share)
        times = [plain_report.seconds(row, 1.0) for row in half if row["outcome"] == "solved"]
        for column, part in (("time, median [ms]", 0.5), ("time, 95 % [ms]", 0.95)):
            assert agrees(line[column], 1e3 * quantile(times, part))
        net = [digits_delivered(row, "net_wrench") for row in half if row["outcome"] == "solved"]
        assert agrees(line["digits of A'lam, median"], quantile(net, 0.5))


def test_the_sentences_above_the_first_table_are_counts_of_all_rows(mixed):
    """Counted by SQL."""
    with closing(sqlite3.connect(mixed / "study.sqlite")) as tables:

        def count(where):
            return tables.execute(f"SELECT count(*) FROM rows WHERE {where}").fetchone()[0]

        said = count("said_optimal AND feasible")
        false = count("said_optimal AND feasible AND wrong")
        multipliers = count("said_optimal AND feasible AND wrong AND wrong_multipliers")
        none = count("said_infeasible")
        untrue = count("said_infeasible AND wrong")
        there = count("said_optimal AND NOT feasible")
        beyond = count("said_optimal AND NOT feasible AND wrong")
        within = " AND ".join(
            f"coalesce(residuals_{name}, 0) <= coalesce(allowed_{name}, 1e300)"
            for name in ("primal", "dual", "gap")
        )
        judged = "coalesce(allowed_primal, allowed_dual, allowed_gap) IS NOT NULL"
        kept = count(f"said_optimal AND wrong AND outcome = 'solved' AND {judged} AND {within}")
    page = markdown_page(study_report(mixed))
    assert false > multipliers > 0
    assert (
        f"Of {said:,} claims of success on problems with a solution {false:,} are false: in "
        f"{multipliers:,} the dual residual or the gap is larger than promised, in the other "
        f"{false - multipliers:,} only"
    ) in page
    assert f"Of {none:,} claims that there is no solution {untrue:,} are false." in page
    assert (
        f"success was claimed {there:,} times: {beyond:,} times falsely, and {there - beyond:,} "
        "times with residuals that keep their limits"
    ) in page
    assert f"{kept:,} of the false claims of success have all of their residuals within" in page
    assert 0 < beyond < there


def test_digits_by_family_are_those_of_the_rows(tables, rows):
    found = plain_report.lines(tables, titled="Median digits by family")
    for _, where, columns, (family, *cells) in found:
        for solver, cell in zip(columns[1:], cells, strict=True):
            own = rows_named(rows, f"{where}, family = {family}, label = {solver}")
            own = [r for r in own if r["outcome"] != "not_run_budget"]
            assert agrees(cell, quantile([digits_delivered(r) for r in own], 0.5))
    assert len(found) == 2 * len(made_store.FAMILIES)


def test_the_lines_of_the_report_make_its_first_table_again(mixed, tmp_path, monkeypatch, cli):
    """Of every interface: setting, problems, digits, times, claims by kind, calls not made."""
    monkeypatch.chdir(tmp_path)
    page = markdown_page(study_report(mixed, tmp_path))
    (command,) = re.findall(r"`quasistatic-ref (study pack .*?)`", page)
    cli(*command.split())
    (program,) = re.findall(r"```text\n(.*?)```", page, re.DOTALL)
    names = {}
    exec(program, names)
    table = names["table"].join(names["claims"])
    again = {key[:2]: (key[3], own) for key, own in table.iterrows()}
    (_, _, columns, body), *_ = (
        table for table in plain_report.tables_of(page) if "its own options" in table[2]
    )
    assert len(body) == len(again) == len(made_store.SOLVERS)
    for line in body:
        shown = dict(zip(columns, line, strict=True))
        setting, own = again[shown["interface"], shown["solver"]]
        assert shown["setting"] == setting
        for kind in names["kinds"]:
            column = next(c for c in columns if c.removeprefix("false: ") == kind)
            assert int(shown[column]) == own[kind]
        assert int(shown["problems"]) == own["problems"]
        assert agrees(shown[columns[columns.index("problems") + 1]].split(" (")[0], own["six"])
        assert agrees(shown[">= 3 digits [%]"], own["three"])
        mean = next(name for name in columns if name.startswith("time to"))
        assert agrees(shown["digits of A'lam, median"], own["net"])
        times = {"time, median [ms]": "median", "time, 95 % [ms]": "slow", mean: "mean",
                 "repeated call, median [ms]": "repeated"}  # fmt: skip
        for column, name in times.items():
            assert float(shown[column]) == pytest.approx(1e3 * own[name], rel=5e-3)  # packed


def headline(folder, rows, **changes):
    """A report on other rows, and the table of every interface in it."""
    folder.mkdir()
    with Store(folder, made_store.STUDY | changes, made_store.facts(12)) as store:
        store.add(*rows)
    page = markdown_page(study_report(folder))
    _, _, columns, body = next(t for t in plain_report.tables_of(page) if "its own options" in t[2])
    return page, [dict(zip(columns, line, strict=True)) for line in body]


def test_times_are_ranked_on_a_quiet_machine_only(store, tmp_path):
    rows = contents(store).rows
    for load, ranked in (("0.4 9 9", True), ("0.6 0 0", False)):
        machine = {"load": load, "cores": 2}
        page, lines = headline(tmp_path / load[:3], rows, machine=machine)
        assert ("Times are not ranked" not in page) == ranked
        name = next(n for n in lines[0] if n.startswith("time to" if ranked else ">= 6"))
        values = [float(line[name].split(" (")[0]) for line in lines]
        assert values == sorted(values, reverse=not ranked)
        assert any(picture.kind == "profiles" for picture in study_report(
            tmp_path / load[:3]).pictures) == ranked  # fmt: skip


def test_bootstraps_hold_their_value_and_narrow_with_the_root_of_the_count():
    """Of a share of one half among n the 95 % are +-1.96 / sqrt(4 n)."""
    for n in (100, 10_000):
        values = np.arange(n) % 2
        strata = np.array(["a", "b"])[np.arange(n) * 2 // n]
        low, high = interval(resampled_means(values, strata))
        expected = 1.96 / np.sqrt(4 * n)
        assert 0.5 - low == pytest.approx(expected, rel=0.3)
        assert high - 0.5 == pytest.approx(expected, rel=0.3)


def test_the_noise_is_the_difference_of_what_was_repeated(store):
    """Median of |t_1 / t_2 - 1|, the larger time above, over all pairs."""
    every = contents(store).rows
    by_key = {}
    for row in every:
        names = ("problem", "solver", "interface", "setting", "units", "warm")
        if row["outcome"] == "solved":
            key = tuple(row[n] for n in names)
            by_key.setdefault(key, []).append(row["seconds"]["call"])
    ratios = [max(pair) / min(pair) - 1 for pair in by_key.values() if len(pair) == 2]
    noise = noise_of(rows_of(every, made_store.LIMIT))
    assert noise.pairs == len(ratios) > 20
    assert noise.call == pytest.approx(np.median(ratios), rel=1e-12)
    assert noise.floor > 0
    assert "not known" in noise_of(rows_of(every[:1], made_store.LIMIT)).words


def test_profiles_are_shares_of_problems_right_in_time(report, tables, rows):
    """rho_s(tau): how many problems s has right within tau times the least time, over all."""
    (picture,) = (p for p in report.pictures if p.kind == "profiles")
    panel = picture.data
    _, _, columns, body = next(table for table in tables if "its own options" in table[2])
    at = {f"{line[1]}:{line[0]}": line[columns.index("setting")] for line in body
          if f"{line[1]}:{line[0]}" in panel["labels"]}  # fmt: skip
    own = [r for r in rows_named(rows, "units = natural, warm = false")
           if at.get(plain_report.entry(r, "label")) == r["setting"]]  # fmt: skip
    own = plain_report.shared_rows(own, ["label"])
    times = {label: {} for label in panel["labels"]}
    for r in own:
        if digits_delivered(r) >= 6:
            times[plain_report.entry(r, "label")][r["problem"]] = plain_report.seconds(r, 1.0)
    problems = {r["problem"] for r in own}
    for label, ratios in zip(panel["labels"], panel["ratios"], strict=True):
        for tau in (1.0, 3.0, 50.0):
            right = 0
            for problem in problems:
                here = [t[problem] for t in times.values() if problem in t]
                right += problem in times[label] and times[label][problem] <= tau * min(here)
            shown = profile(ratios, np.array([tau]))[0]
            assert shown == pytest.approx(100 * right / len(problems), rel=1e-12)


@pytest.mark.parametrize(("times", "right", "ratios"), [
    ([[1, 2], [4, 1]], [True, False], [[1, np.inf], [4, np.inf]]),  # the second by no solver
    ([[0, 0], [2e-9, 0]], [True, True], [[1, 1], [2, 1]]),  # no time is one tick of the clock
])  # fmt: skip
def test_ratios_of_a_profile_are_those_to_the_least_time(times, right, ratios):
    found = performance_ratios(np.array(times, float), np.array([right, right]))
    np.testing.assert_array_equal(found, ratios)


def test_the_html_page_shows_the_same_tables_without_network(report, tables):
    text = html_page(report, {p.name: b"<svg/>" for p in report.pictures}, sorting_script())
    found = [
        unescape(re.sub("<.*?>", "", cell)) for cell in re.findall("<t[dh].*?>(.*?)</t[dh]>", text)
    ]
    assert found == [
        c.replace("`", "") for _, _, head, body in tables for row in (head, *body) for c in row
    ]
    assert not re.search("<(link|iframe|object)|url\\(|@import", text)
    assert re.findall("<script.*?>", text) == ["<script>"]  # inline: loads nothing
    assert not re.search("fetch|import|XMLHttp|http|eval|innerHTML", sorting_script())
    links = re.findall(r'(?:src|href)="(.*?)"', text)
    assert all(link.startswith(("#", "data:image/svg+xml;base64,")) for link in links)


def test_a_sweep_is_reported_run_by_run_and_drawn_where_it_was_done(tmp_path):
    (tmp_path / TABLE).write_text(made_store.SWEEP)
    report = study_report(tmp_path)
    (_, where, columns, body), *_ = plain_report.tables_of(markdown_page(report))
    head, *lines = (line.split(",") for line in made_store.SWEEP.splitlines())
    assert where == TABLE
    assert columns == ["mu [the scenario's unit]", "cone", "outcome", *head[5:]]
    for shown, line in zip(body, lines, strict=True):
        assert shown[1:3] == [line[2], line[4] or line[3]]
        numbers = [line[1], *line[5:]]
        assert [c if c == "-" else float(c) for c in (shown[0], *shown[3:])] == [
            float(n) if n else "-" for n in numbers
        ]
    (picture,) = report.pictures
    assert picture.data["lines"] == {
        "cone = pyramid": [(0.0, 0.25, 20.0), (0.1, 1.25, 20.0), (0.3, 3.25, 20.0)],
        "cone = product": [(0.0, 0.125, 10.0)],
    }


@pytest.mark.parametrize("text", ["", "run,mu,outcome\n", made_store.SWEEP[:-20], "a" * 200_000])
def test_what_no_sweep_has_written_is_refused(tmp_path, text):
    (tmp_path / TABLE).write_text(text)
    with pytest.raises(InputError, match="is no table of a sweep; run the sweep again"):
        study_report(tmp_path)


def test_names_are_shown_in_markdown_not_obeyed():
    name = "<script>alert(1)</script>"
    table = Table(name, f"solver {name}", ("solver", name), ((name, "1 < 2"),))
    blocks = (f"Of {name}.", table, Code(f"{name}\n```\n{name}"))
    page = markdown_page(Report(name, (Section(name, blocks),)))
    outside, code, after = page.split("````")
    assert "<" not in outside.replace("1 < 2", "")
    assert outside.count("&lt;script>alert(1)&lt;/script>") == 7
    assert code == f"text\n{name}\n```\n{name}\n"  # a block of code, longer than that in it
    assert after == "\n"
