"""Scenes, each with what is right by hand, and nothing else is said of it (cases/*.toml)."""

import pytest

from quasistatic_ref import RunFailed
from tests.optional.doctor.mistake_scenes import GRAVE
from tests.optional.rows import CASES, assert_found, made, params


def found(scenario):
    """What is found of a run, though it may end early."""
    try:
        return scenario.run(progress=False).findings
    except RunFailed as failure:
        return failure.trajectory.findings


@pytest.mark.shared
@pytest.mark.parametrize("case", params(CASES))
def test_a_scene_has_the_findings_of_its_row_and_no_others(case):
    """A remedy that is applied ends what asked for it."""
    scenario = made(case)
    findings = scenario.findings() if "before" in case else found(scenario)
    assert all(GRAVE[one.name] in (None, one.grave) for one in findings)
    assert_found(findings, case["hand"])
    for remedy, changes in case.get("after", {}).items():
        mended = {one.name for one in findings if one.remedy == remedy}
        assert mended
        assert mended.isdisjoint(one.name for one in found(made(case, changes)))


SLIPS = ["a rod slips", pytest.param("a cube that a finger pushes at 0.1", marks=pytest.mark.long)]


@pytest.mark.parametrize("what", SLIPS)
def test_findings_do_not_depend_on_the_backend(what):
    """Contacts share loads in many ways, and backends differ in theirs."""
    (case,) = [case for case in CASES if case["what"].startswith(what)]
    run = made(case).run(progress=False)
    for backend in ("clarabel", "osqp", "none"):
        proved = made(case, fast=False, solver={"backend": backend})
        other = proved.run(progress=False)
        assert other.header.not_looked_at == run.header.not_looked_at == ""
        said = {one.name: one for one in other.findings}
        assert said.keys() == case["hand"].keys()
        for one in run.findings:
            assert said[one.name].numbers == pytest.approx(one.numbers, rel=1e-6, abs=1e-6)
