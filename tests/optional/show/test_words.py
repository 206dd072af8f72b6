"""What objects say of themselves: short, true, and safe whatever a name holds."""

import re
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from quasistatic_ref import (
    Extra,
    RunFailed,
    Trajectory,
    load_scenario,
    load_trajectory,
    save_trajectory,
    solve_step,
)
from quasistatic_ref.optional.show.show import (
    MOST_IN_HTML,
    MOST_SHOWN,
    clipped,
    html_page,
    text_page,
)
from tests.helpers import (
    changed,
    first_step,
    point_on_floor,
    random_step,
)
from tests.made import no_contacts
from tests.scenes import SWING, written_scenario

LINES = 20
WIDTH = 100
TAGS = {*["div", "p", "strong", "br", "table", "thead", "tbody", "tr", "th", "td"]}
HOSTILE = '<script>alert("&")</script>\n\x1b[31m\u202e' + "long" * 50


def element(page):
    """A page as an element of XML: what is not closed, or not escaped, is an error."""
    return ElementTree.fromstring(page.replace("<br>", "<br/>"))


def check(*objects):
    """Every object is short in a terminal and a sound element in a notebook."""
    for one in objects:
        lines = repr(one).splitlines()
        assert 1 <= len(lines) <= LINES
        assert max(map(len, lines)) <= WIDTH
        assert all(line.isprintable() and line == line.rstrip() for line in lines)
        assert lines[0].startswith(tuple(kind.__name__ for kind in type(one).__mro__[:-1]))
        if hasattr(one, "_repr_html_"):
            page = element(one._repr_html_())
            assert {part.tag for part in page.iter()} <= TAGS
            assert {name for part in page.iter() for name in part.attrib} <= {"scope", "style"}
            assert "".join(page.itertext()).startswith(lines[0].removesuffix("...")[:60])
            assert len({len(row) for row in page.iter("tr")}) <= 1


def test_every_object_of_a_run_is_short():
    scenario = load_scenario("bunny_grasp", steps=2, fast=True)
    result = first_step(scenario)
    run = scenario.run()
    light = replace(scenario, record="light").run()
    check(scenario, run, light, result.step, result.solution.certificate)
    assert not re.search("f_n|tau_n", repr(light))  # those of lam are not unique
    assert repr(light).count("\n  grip(gripper/l...ger#0, bunny)/") > 1
    loads = [float(line.split()[-2]) for line in repr(run).splitlines()[-13:-1]]
    assert loads[0] > 1e-3 * max(loads) >= loads[-1]  # what bears load comes first


def test_empty_things_are_short_too(tmp_path, rng):
    nothing = random_step(rng, rows=()).replace(contacts=no_contacts(7))
    empty = load_scenario("sphere_spin", steps=0, fast=True).run()
    check(nothing, solve_step(nothing).certificate, empty)
    assert "0 contacts" in repr(nothing)
    assert "0 steps" in repr(empty)
    with pytest.raises(RunFailed) as caught:
        load_scenario(written_scenario(tmp_path, SWING), fast=True).run()
    failed = caught.value.trajectory
    check(failed)
    assert "ended early" in repr(failed)
    assert "why it ended: step 3:" in repr(failed)


def test_words_of_multipliers_and_active_rows_say_the_known_facts_alone():
    """Two rows, n + mu d1 >= 0 and n - mu d1 >= 0, keep a point where nothing pulls along d2."""
    step = point_on_floor(force=(0.0, 0.0, -1.0))
    proved = solve_step(step)
    off = solve_step(step, certify="off")
    said = "2 active rows; multipliers not unique, delta_q differentiable"
    assert said in repr(proved.certificate)
    assert "multipliers" not in repr(off.certificate)


def test_a_step_shows_its_nearest_contacts_first(rng):
    step = random_step(rng, rows=(4,) * 4)
    gaps = [2e-3, 0.0, 1e-3, 0.0]
    step = step.replace(contacts=changed(step.contacts, name=tuple("abcd"), phi=gaps))
    assert [line.split()[0] for line in repr(step).splitlines()[2:]] == ["b", "d", "c", "a"]


def test_names_are_escaped_and_cut():
    step = point_on_floor(force=(0, 0, -1.0))
    step = step.replace(
        contacts=changed(step.contacts, name=(HOSTILE,)),
        extra=Extra((HOSTILE,), np.zeros((1, 3)), [-1.0]),
    )
    check(step)
    page = step._repr_html_()
    assert "<script" not in page
    assert "&lt;script&gt;alert(&quot;&amp;&quot;)" in page
    assert '<script>alert("&")</script>\\n\\x1b[31m\\u202e' in "".join(element(page).itertext())


def test_a_step_says_what_it_holds():
    assert repr(point_on_floor(m=0.3, mu_v=0.25, phi=0.00125)) == (
        "StepData: h = 0.01 s, 3 coordinates (0 actuated), 1 contact, 4 rows, cone pyramid\n"
        "  contact  gap [m]                 normal  mu_v  mu_omega [m]  rows\n"
        "  c0       0.00125  (0.000, 0.000, 1.000)  0.25             0     4"
    )


STRANGE = {
    "a backend that is markup": {"backend": HOSTILE},
    "names that are markup": {"contacts": ((HOSTILE,) * 8,) * 3},
}


@pytest.mark.parametrize("header", STRANGE.values(), ids=STRANGE)
def test_a_strange_trajectory_that_can_be_read_can_be_shown(header, tmp_path):
    run = load_scenario("block_push", steps=3, fast=True).run()
    strange = Trajectory(replace(run.header, **header), run.arrays)
    check(strange, load_trajectory(save_trajectory(tmp_path / "run.npz", strange)))


def test_words_and_numbers_are_cut_where_they_must():
    assert clipped("a" * 101) == "a" * 97 + "..."
    # Of 37 characters a cell keeps 32: 14, three dots and the end, by which names differ.
    page = "", (), ("name",), [("grip(gripper/left_finger#0, bunny)/17",)]
    assert text_page(page).endswith("\n  grip(gripper/l...er#0, bunny)/17")
    page = text_page(("t", [str(i) for i in range(99)], ("a", "b"), [("1", "2")] * 99))
    assert len(page.splitlines()) == LINES
    assert text_page(("t", (), ("a",), [("1",)] * (MOST_SHOWN + 1))).endswith("... and 1 more")
    page = html_page(("t", (), ("a",), [("1",)] * (MOST_IN_HTML + 1)))
    assert page.count("<tr>") == 1 + MOST_IN_HTML
    assert page.endswith("<p>and 1 more</p></div>")


@pytest.mark.parametrize("accuracy", [1e-9, 1e-12])
def test_a_run_without_proof_prints_no_rounding(accuracy):
    """The block rests: 4.905 N on four corners, gaps of zero, and no friction."""
    run = load_scenario("block_push", steps=3, accuracy=accuracy, certify="off").run(progress=False)
    printed = repr(run)
    assert "3 steps by clarabel, nothing proved (certify = off)" in printed
    assert "number 0, largest boundary layer 0 m" in printed
    assert not re.search(r"\de-\d", printed)
    rests = [line.split()[-5:] for line in printed.splitlines() if "floor(" in line]
    assert rests == 4 * [["0", "0", "0", "1.226", "0"]]
