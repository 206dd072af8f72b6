"""A challenge finds what is wrong, names it, makes it small, and is the same for the same seed."""

import json
import shlex

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.lab.vectors.challenge.fresh import EASY, HARD, PLAIN, fresh_case, record_of
from quasistatic_ref.lab.vectors.challenge.rounds import challenge
from quasistatic_ref.lab.vectors.challenge.simpler import MOVES, shrunk
from quasistatic_ref.lab.vectors.check.patched import program
from quasistatic_ref.lab.vectors.layers import LAYERS, layer
from tests.lab.vectors.challenge.programs import command
from tests.lab.vectors.committed_cases import PLAIN_PROGRAM


def without_spin(name, case):
    output = program()(name, case)
    if name == "jacobian":
        output["J"] = [[*J[:3], [-x for x in J[3]]] for J in output["J"]]
    return output


def test_the_same_seed_gives_the_same_findings_and_another_other_cases():
    def first(seed, **more):
        found = challenge(without_spin, layers=["jacobian"], cases=6, seed=seed, **more)
        return [finding.record for finding in found.findings]

    assert first(3) == first(3) == first(3, jobs=2)
    one, other = (fresh_case("rows", (seed, 0, 0), PLAIN)[0] for seed in (3, 4))
    assert one != other


def test_a_function_that_raises_or_returns_no_output_is_a_finding():
    def raises(name, case):
        raise ZeroDivisionError("no mass")

    (finding,) = challenge(raises, layers=["rows"], cases=6).findings
    assert (finding.kind, finding.reason) == ("error", "error: ZeroDivisionError: no mass")
    (finding,) = challenge(lambda *_: object(), layers=["rows"], cases=6).findings
    assert finding.kind == "wrong"
    found = challenge(lambda *_: None, layers=["rows"], cases=30)
    assert (found.status, found.remarks) == (0, ["rows is not supported"])


@pytest.mark.parametrize("level", [EASY, PLAIN, HARD])
@pytest.mark.parametrize("name", LAYERS)
def test_every_fresh_case_is_valid_and_the_same_again(name, level):
    case, record = fresh_case(name, (5, level, 1), level)
    again = fresh_case(name, (5, level, 1), level)
    assert (case, record) == again
    assert record_of(name, json.loads(json.dumps(case))) == record


def test_the_first_round_has_one_contact_and_round_numbers():
    for number in range(10):
        case, _ = fresh_case("rows", (0, 0, number), EASY)
        (contact,) = case["contacts"]
        assert sorted(map(abs, contact["n"])) == [0.0, 0.0, 1.0]
        assert float(f"{contact['mu_v']:.1g}") == contact["mu_v"]


@pytest.mark.parametrize("name", LAYERS[:8])  # derivatives have the inputs of steps
def test_every_move_makes_another_input_and_some_are_valid(name):
    case, _ = fresh_case(name, (0, 1, 0), PLAIN)
    text = json.dumps(case)
    valid = 0
    for move in MOVES:
        for other in list(move(case))[:8]:
            assert json.dumps(case) == text  # what is given stays as it is
            valid += record_of(name, other) is not None
    assert valid > 3


def test_shrinking_ends_where_no_single_move_fails_any_more():
    case, _ = fresh_case("rows", (0, 1, 2), PLAIN)

    def fails(other):  # something with J[0][0][0] beyond a half
        return bool(other["contacts"]) and abs(other["contacts"][0]["J"][0][0]) > 0.5

    case["contacts"][0]["J"][0][0] = 0.75
    small = shrunk(case, fails, 2000)
    assert len(small["contacts"]) == 1
    assert np.shape(small["contacts"][0]["J"]) == (4, 1)
    assert np.count_nonzero(small["contacts"][0]["J"]) == 1


def test_the_command_writes_counterexamples_that_can_be_sent_again(tmp_path, cli):
    out = tmp_path / "found"
    program = command("wrong", tmp_path)
    given = ["vectors", "challenge", "--command", program, "--layer", "selection", "--cases", "6"]
    printed = cli(*given, "--out", out, "--quiet", status=1)
    (folder,) = out.iterdir()
    assert printed.out.splitlines()[-1] == str(folder)
    page = (folder / "README.md").read_text()
    (line,) = (line for line in page.splitlines() if "--again" in line)
    wanted = ["--command", program, "--again", str(folder / "counterexample.json")]
    assert shlex.split(line)[3:] == wanted  # as a shell takes it apart
    again = ["--again", folder / "counterexample.json"]
    (record,) = json.loads(
        cli("vectors", "challenge", "--command", program, *again, "--json", status=1).out
    )["findings"]
    assert record["case"] == json.loads((folder / "counterexample.json").read_text())["case"]
    right = command("right", tmp_path)
    cli("vectors", "challenge", "--command", right, *again, "--quiet")


SEEN_BY_FEW = {
    "springs one by one": ("step", """step.py:
- K_q = np.array(case["K_q"]).reshape(n_a, n_a)
+ K_q = np.diag(np.diag(np.array(case["K_q"]).reshape(n_a, n_a)))"""),
    "the last of equal axes": ("step", """candidates.py:
- i = int(np.argmin(np.abs(n)))
+ i = 2 - int(np.argmin(np.abs(n)[::-1]))"""),
    "the later of equal distances": ("selection", """candidates.py:
- order = np.argsort(phi, kind="stable")
+ order = np.lexsort((-np.arange(len(phi)), phi))"""),
    "a normal from inside in the frame of the box": ("distance", """distance.py:
- return phi - r, R @ (x + r * n) + t, R @ y + t, R @ n
+ return phi - r, R @ (x + r * n) + t, R @ y + t, R @ n if phi > 0 else n"""),
    "no direction on the axis of a cylinder or a cone": ("distance", """curved.py:
- outward = np.array([p[0] / r, p[1] / r, 0]) if r > 0 else AXES[0]
+ outward = np.array([p[0] / max(r, 1e-300), p[1] / max(r, 1e-300), 0])"""),
}  # fmt: skip


@pytest.mark.parametrize(("layer", "patch"), SEEN_BY_FEW.values(), ids=SEEN_BY_FEW)
def test_a_bug_that_shows_in_special_cases_alone_is_found(layer, patch):
    outcome = challenge(program(patch), layers=[layer], cases=120, first=True)
    assert outcome.findings


def test_the_plain_program_is_found_right(tmp_path, capsys):
    given = ["vectors", "challenge", "--command", PLAIN_PROGRAM, "--cases", "44", "--seed", "1"]
    given += ["--timeout", "100", "--quiet", "--out", str(tmp_path)]
    assert main(given) == 0, capsys.readouterr().err


def test_the_package_itself_is_found_right():
    def own(name, case):
        return layer(name).own(case)

    assert challenge(own, cases=44, seed=1).findings == []
