"""The set that ships: its files, its answers by other arithmetic, and what is refused."""

import json
import re
import shutil
from dataclasses import replace
from fractions import Fraction
from hashlib import sha256

import numpy as np
import pytest

from quasistatic_ref.cli.main import main
from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.folders import problem_set_folder
from quasistatic_ref.lab.study.problems.checking import refutation
from quasistatic_ref.lab.study.problems.editions import FROZEN, edition_problem
from quasistatic_ref.lab.study.problems.folder import FACTS, MANIFEST, NUMBERS, manifest, set_read


def exact(values):
    """Float64 numbers as fractions."""
    return [Fraction(v) for v in np.ravel(values).tolist()]


def solved_exactly(M, v):
    """M^-1 v in fractions, by elimination."""
    rows = [[*row, w] for row, w in zip(M, v, strict=True)]
    for k in range(len(rows)):
        p = next(i for i in range(k, len(rows)) if rows[i][k])
        rows[k], rows[p] = rows[p], rows[k]
        rows[k] = [w / rows[k][k] for w in rows[k]]
        for i in range(len(rows)):
            if i != k and rows[i][k]:
                rows[i] = [a - rows[i][k] * b for a, b in zip(rows[i], rows[k], strict=True)]
    return [row[-1] for row in rows]


def test_the_set_that_ships_is_the_one_that_was_frozen():
    assert list(FROZEN) == ["contact-qp-1"]
    assert edition_problem(problem_set_folder()) is None


def test_small_answers_are_optimal_in_fractions(members):
    """H x - g = A_W' lam, lam > 0, A x >= b with equality on W, x* correctly rounded."""
    small = [one for one in members if one.facts["n"] <= 6 and one.facts["kind"] == "qp"
             and not one.answer.farkas]  # fmt: skip
    for one in small[:: len(small) // 12]:
        form, W = one.form, np.flatnonzero(one.answer.lam)
        n, k = len(form.g), len(W)
        H, A = (np.array(exact(M), dtype=object).reshape(M.shape) for M in (form.H, form.A))
        K = [[*H[i], *(-A[W, i])] for i in range(n)]
        K += [[*A[w], *[Fraction(0)] * k] for w in W]
        solution = solved_exactly(K, [*exact(form.g), *exact(form.b[W])])
        x, lam = solution[:n], solution[n:]
        assert all(v > 0 for v in lam)
        slack = [sum(a * v for a, v in zip(row, x, strict=True)) - b
                 for row, b in zip(A, exact(form.b), strict=True)]  # fmt: skip
        assert min(slack) >= 0
        assert [float(v) for v in x] == one.answer.x.tolist()
        assert [float(v) for v in slack] == one.answer.slack.tolist()


def test_a_sample_of_all_answers_is_proved_again_without_a_solver(members):
    kinds = {"conic": [one for one in members if one.facts["kind"] == "socp"][::90]}
    kinds["sparse"] = [one for one in members if "sparse" in one.facts["tags"]][:3]
    kinds["rows"] = [one for one in members if one.facts["kind"] == "qp"
                     and one.facts["n"] < 25][::97]  # fmt: skip
    assert all(kinds.values())
    for some in kinds.values():
        assert [refutation(one) for one in some] == [None] * len(some)


@pytest.mark.parametrize("kind", ["exact", "enclosed", "bounded", "infeasible"])
def test_an_answer_that_was_changed_is_refuted(members, kind):
    def of_kind(one):
        return kind == ("infeasible" if one.answer.farkas else one.answer.kind)

    one = next(one for one in members if of_kind(one))
    if kind == "infeasible":
        some = dict(one.answer.farkas)
        first = next(iter(some))
        some[first] = str(Fraction(some[first]) * (1 + Fraction(1, 2**60)))
        changed = replace(one.answer, farkas=some)
    else:
        off = {"exact": 2e-16, "enclosed": 1e-12, "bounded": 1e-5}[kind]
        changed = replace(one.answer, x=one.answer.x * (1 + off))
    assert refutation(one) is None
    assert refutation(replace(one, answer=changed)) is not None


def test_the_code_of_the_readme_reads_what_the_package_reads(members):
    page = (problem_set_folder() / "README.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    names = {}
    exec(code, names)
    for family in ("wedge", "infeasible", "ellipsoid"):
        own = [one for one in members if one.facts["family"] == family]
        found = list(names["problems"](problem_set_folder(), family))
        assert len(found) == len(own)
        for (facts, numbers), one in zip(found, own, strict=True):
            assert facts["id"] == one.id
            np.testing.assert_array_equal(numbers["A"].toarray(), one.A.toarray())
            np.testing.assert_array_equal(numbers["b"], one.b)
            np.testing.assert_array_equal(2.0 ** numbers["coordinate"], one.units.coordinate)
            if not facts["farkas"]:
                np.testing.assert_array_equal(numbers["net"], one.answer.net)


def test_a_set_whose_numbers_were_changed_is_refused(tmp_path):
    shutil.copytree(problem_set_folder(), tmp_path / "set")
    path = tmp_path / "set" / NUMBERS / "wedge.npz"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))
    with pytest.raises(InputError, match=r"wedge.npz.*changed|changed"):
        set_read(tmp_path / "set")
    with pytest.raises(InputError, match="holds no set of problems"):
        set_read(tmp_path)


@pytest.mark.parametrize("spoilt", ["", "[]", "{}", '{"id": 1, "family": "wedge", "n": -1}', "x"])
def test_a_set_whose_lines_are_something_else_is_refused(tmp_path, spoilt):
    """Its manifest lists the files as they are."""
    (tmp_path / NUMBERS).mkdir()
    shutil.copy(problem_set_folder() / NUMBERS / "wedge.npz", tmp_path / NUMBERS)
    (tmp_path / FACTS).write_text(spoilt)
    files = [FACTS, f"{NUMBERS}/wedge.npz"]
    listed = [{"path": name, "sha256": sha256((tmp_path / name).read_bytes()).hexdigest()}
              for name in files]  # fmt: skip
    head = manifest(problem_set_folder()) | {"families": {"wedge": {}}, "files": listed}
    (tmp_path / MANIFEST).write_text(json.dumps(head))
    with pytest.raises(InputError):
        set_read(tmp_path)


def test_other_problems_under_the_name_of_a_set_are_found_out(tmp_path):
    shutil.copytree(problem_set_folder(), tmp_path / "set")
    path = tmp_path / "set" / MANIFEST
    head = json.loads(path.read_text())
    head["families"]["wedge"]["dial"]["unit"] = "mrad"
    path.write_text(json.dumps(head))
    found = edition_problem(tmp_path / "set")
    assert found == "calls itself contact-qp-1 and has other problems: give it another name"


def test_what_is_asked_for_and_is_not_there_is_refused(tmp_path, capsys):
    export = ["study", "problems", "export", "--to", "npz", "--out", str(tmp_path)]
    for more, words in (
        (["--families", "wedges"], "is no family of the set"),
        (["--id", "wedge/9/9"], "is no problem of the set"),
        (["--every", "0"], "must be at least 1"),
        (["--families", "wedge", "--tag", "nothing"], "holds no problem"),
    ):
        assert main([*export, *more]) == 2
        assert words in capsys.readouterr().err


def test_the_commands_say_what_the_set_has(capsys):
    assert main(["study", "problems", "check"]) == 0
    assert "problems, as the manifest lists them" in capsys.readouterr().out
    assert main(["study", "problems", "list"]) == 0
    assert "contact-qp-1" in capsys.readouterr().out
