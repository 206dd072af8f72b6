"""The sets that ship: their files, their answers by other arithmetic, and what is refused."""

import json
import re
import shutil
import sys
from dataclasses import replace
from fractions import Fraction
from hashlib import sha256

import numpy as np
import pytest

from quasistatic_ref import InputError
from quasistatic_ref.lab.folders import CONTACT_QP_1, CONTACT_QP_2, EDITIONS, problem_set_folder
from quasistatic_ref.lab.study.problems.checking import refutation
from quasistatic_ref.lab.study.problems.editions import FROZEN, edition_problem
from quasistatic_ref.lab.study.problems.folder import FACTS, MANIFEST, NUMBERS, manifest, set_read
from tests.oracles import rational_kkt
from validation.make import proved_problems

NEWER = problem_set_folder(CONTACT_QP_2)


@pytest.mark.parametrize("name", EDITIONS)
def test_a_set_that_ships_is_the_one_that_was_frozen(name):
    assert list(FROZEN) == [*EDITIONS]
    assert edition_problem(problem_set_folder(name)) is None


def test_wrong_answers_and_wrong_proofs_are_refuted_in_fractions():
    """At the minimum of x^2 / 2 over x >= 1, x = lam = 1; with x <= -2 as well, b'y = 3."""
    A = np.array([[1.0], [-1.0]])
    b = np.array([1.0, 2.0])
    one = np.ones(1)
    none = np.zeros(1)
    row = np.eye(1), none, A[:1]
    off = np.nextafter(one, 2)
    said = {
        None: (b[:1], one, one, none, one),
        "a row is violated": (b[:1], none, none, -one, none),
        "a multiplier is not positive": (-b[:1], -one, -one, none, one),
        "x is not rounded correctly": (b[:1], off, one, none, one),
        "net is not rounded correctly": (b[:1], one, off, none, one),
        "slack is not rounded correctly": (b[:1], one, one, off, one),
    }
    assert [rational_kkt.refutation(*row, *answer) for answer in said.values()] == list(said)
    proofs = {
        None: (b, {0: "1", 1: "1"}),
        "A'y is not zero": (b, {0: "1", 1: "2"}),
        "a weight is not positive": (b, {0: "-1", 1: "-1"}),
        "b'y is not positive": (-b, {0: "1", 1: "1"}),
    }
    assert [rational_kkt.farkas_refutation(A, *proof) for proof in proofs.values()] == list(proofs)


@pytest.mark.parametrize("kind", ["exact", "enclosed", "bounded", "infeasible"])
def test_an_answer_that_was_changed_is_refuted(members, older, kind):
    def of_kind(one):
        return kind == ("infeasible" if one.answer.farkas else one.answer.kind)

    one = next(one for one in [*members, *older] if of_kind(one))
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


@pytest.mark.parametrize("name", EDITIONS)
def test_the_code_of_the_readme_reads_what_the_package_reads(name, members, older):
    folder = problem_set_folder(name)
    every = {CONTACT_QP_1: older, CONTACT_QP_2: members}[name]
    page = (folder / "README.md").read_text("utf-8")
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.MULTILINE | re.DOTALL)
    names = {}
    exec(code, names)
    for family in {"wedge", "ellipsoid", "capped_wedge", "jammed"} & manifest(folder)[
        "families"
    ].keys():
        own = [one for one in every if one.facts["family"] == family]
        found = list(names["problems"](folder, family))
        assert len(found) == len(own)
        for (facts, numbers), one in zip(found, own, strict=True):
            assert facts["id"] == one.id
            np.testing.assert_array_equal(numbers["A"].toarray(), one.A.toarray())
            np.testing.assert_array_equal(numbers["b"], one.b)
            np.testing.assert_array_equal(2.0 ** numbers["coordinate"], one.units.coordinate)
            if not facts["farkas"]:
                np.testing.assert_array_equal(numbers["net"], one.answer.net)


def test_a_set_whose_numbers_were_changed_is_refused(tmp_path):
    shutil.copytree(NEWER, tmp_path / "set")
    path = tmp_path / "set" / NUMBERS / "limits.npz"
    content = bytearray(path.read_bytes())
    content[len(content) // 2] ^= 1
    path.write_bytes(bytes(content))
    with pytest.raises(InputError, match=r"limits.npz.*changed|changed"):
        set_read(tmp_path / "set")
    with pytest.raises(InputError, match="holds no set of problems"):
        set_read(tmp_path)


@pytest.mark.parametrize("spoilt", ["", "[]", "{}", '{"id": 1, "family": "limits", "n": -1}', "x"])
def test_a_set_whose_lines_are_something_else_is_refused(tmp_path, spoilt):
    """Its manifest lists the files as they are."""
    (tmp_path / NUMBERS).mkdir()
    shutil.copy(NEWER / NUMBERS / "limits.npz", tmp_path / NUMBERS)
    (tmp_path / FACTS).write_text(spoilt)
    files = [FACTS, f"{NUMBERS}/limits.npz"]
    listed = [{"path": name, "sha256": sha256((tmp_path / name).read_bytes()).hexdigest()}
              for name in files]  # fmt: skip
    head = manifest(NEWER) | {"families": {"limits": {}}, "files": listed}
    (tmp_path / MANIFEST).write_text(json.dumps(head))
    with pytest.raises(InputError):
        set_read(tmp_path)


def test_other_problems_under_the_name_of_a_set_are_found_out(tmp_path):
    shutil.copytree(NEWER, tmp_path / "set")
    path = tmp_path / "set" / MANIFEST
    head = json.loads(path.read_text())
    head["families"]["limits"]["dial"]["unit"] = "mrad"
    path.write_text(json.dumps(head))
    found = edition_problem(tmp_path / "set")
    assert found == "calls itself contact-qp-2 and has other problems: give it another name"


def test_what_is_asked_for_and_is_not_there_is_refused(tmp_path, cli):
    export = ["study", "problems", "export", "--to", "npz", "--out", tmp_path]
    for more, words in (
        (["--families", "wedges"], "is not a family of the set"),
        (["--id", "wedge/9/9"], "is not a problem of the set"),
        (["--every", "0"], "must be at least 1"),
        (["--families", "limits", "--tag", "nothing"], "holds no problem"),
    ):
        assert words in cli(*export, *more, status=2).err


def test_the_commands_say_what_the_set_has(cli):
    assert "problems, as the manifest lists them" in cli("study", "problems", "check").out
    for name in EDITIONS:
        assert name in cli("study", "problems", "list", name).out


def test_a_sample_of_each_family_is_proved_both_ways(tmp_path, monkeypatch):
    """One problem in 91, the first of each family among them."""
    page = tmp_path / "page.md"
    monkeypatch.setattr(sys, "argv", ["", "--every", "91", "--out", str(page)])
    with pytest.raises(SystemExit, match="0"):
        proved_problems.main()
    text = page.read_text("utf-8")
    assert text.count(": 0 refuted") == 2
    assert all(f"`{family}`" in text for family in manifest(NEWER)["families"])
