"""Whatever stands in a solution file is proved: every field of every kind is forged."""

import json
from collections import Counter
from dataclasses import fields, replace
from itertools import product

import numpy as np
import pytest

from quasistatic_ref import Certificate, solve_step, verify
from quasistatic_ref.optional.ellipsoid.cone import ELLIPSOID_CONE
from quasistatic_ref.step.cones import ELLIPSOID, PYRAMID, cone
from tests.cases import cases, first
from tests.oracles.forged_scenes import between_walls, scenes
from tests.oracles.forgeries import at_random, good_file, outcomes, reason
from tests.oracles.random_steps import drawn
from tests.oracles.records import places
from tests.oracles.solution_truth import solution_file, truth_of, wrenches

SCENES = scenes()
PROVES_NOTHING = ("none", "residual", "residual in the ellipsoid")
RANDOM = 20
"""Random forgeries of the file of each scene: 1 s in all."""


@pytest.fixture
def path(tmp_path):
    return tmp_path / "solution.json"


def field_names(record):
    """The names of all fields that stand in a record."""
    return {".".join(k for k in where if isinstance(k, str)) for where in places(record)}


@pytest.mark.parametrize("every", first(1, [3, 1]))
@pytest.mark.parametrize(("kind", "name"), dict(SCENES.keys()).items())  # one of each kind
def test_no_false_file_passes(path, kind, name, every):
    step = SCENES[kind, name]
    good = good_file(step, kind)
    assert bool(reason(step, good, path)) == (kind in PROVES_NOTHING)
    counts = {}
    for field, said, forged in outcomes(step, good, path, every):
        assert said != "PASSED", (field, forged)
        counts.setdefault(field, Counter())[said] += 1
    assert counts.keys() >= field_names(good)
    assert all(said["refused"] for said in counts.values())
    freely = {field for field, said in counts.items() if said["still true"]}
    allowed = {"delta_q", "lam", "lam and wrench", "certificate.error_bound", "certificate.gap"}
    allowed = {"farkas"} if kind == "infeasible" else allowed
    assert freely <= {*allowed, "some at random"}
    if kind == "exact":
        assert not freely


@pytest.mark.parametrize(("kind", "name"), SCENES)
def test_no_random_forgery_passes(path, kind, name):
    step = SCENES[kind, name]
    good = good_file(step, kind)
    rng = np.random.default_rng(1)
    truth = truth_of(step, good)
    tried = [forged for _ in range(RANDOM) if (forged := at_random(rng, step, good)) != good]
    assert len(tried) > RANDOM / 2
    for forged in tried:
        assert reason(step, forged, path) or truth(forged), forged


def test_every_kind_and_every_claim_of_a_certificate_is_forged():
    """A kind without a scene, or a claim that is in no kind of file, would not be attacked."""
    in_files = {"kind"}
    for name, claims, label in (
        (PYRAMID, cone(PYRAMID).claims, ""),
        (ELLIPSOID, ELLIPSOID_CONE.claims, " in the ellipsoid"),
    ):
        for kind, names in claims.items():
            short = kind in ("none", "enclosure")
            assert any(kind + label * (not short) == scene for scene, _ in SCENES), (kind, name)
            in_files |= set(names)
    in_memory = {"residuals", "step"}
    assert in_files | in_memory == {field.name for field in fields(Certificate)}


def test_a_force_between_walls_that_nothing_touches_is_refused(path):
    """1,000 N on both walls, 1 m away: balanced, in their cones, and at work over 1 m each."""
    step = between_walls()
    record = json.loads(solution_file(step))
    assert reason(step, record, path) is None
    for wall in (1, 2):
        record["lam"][wall][0] += 1000.0 * step.h
    record["wrench"] = wrenches(step, record["lam"])
    claims = record["certificate"]
    for gap, bound in product((claims["gap"], 1e9), (claims["error_bound"], 1e9)):
        claims |= {"gap": gap, "error_bound": bound}
        said = reason(step, record, path)
        assert "error_bound is 1" in said or "presses where nothing touches" in said


IN_MEMORY = {
    "another net impulse": lambda s: {"net_impulse": s.net_impulse + 1e-3},
    "the opposite one": lambda s: {"net_impulse": -s.net_impulse},
    "one of NaN": lambda s: {"net_impulse": np.full(s.step.n_v, np.nan)},
    "one of another length": lambda s: {"net_impulse": s.net_impulse[1:]},
    "costs of an extension": lambda s: {"alone": False},
    "residuals of None": lambda s: {"certificate": replace(s.certificate, residuals=None)},
    "residuals of NaN": lambda s: {
        "certificate": replace(s.certificate, residuals={"primal": np.nan})
    },
    "no step": lambda s: {"certificate": replace(s.certificate, step=None)},
}
"""What a solution claims that stands in no file."""


@cases("change", IN_MEMORY)
@pytest.mark.parametrize(("kind", "name"), [k for k in SCENES if k[0].startswith(("ex", "en"))])
def test_no_claim_of_a_solution_in_memory_is_believed(kind, name, change):
    """Without a net impulse it claims nothing of it."""
    solution = solve_step(SCENES[kind, name])
    assert verify(solution)
    assert verify(replace(solution, net_impulse=None))
    assert not verify(replace(solution, **change(solution)))


def test_the_net_impulse_of_every_solution_holds(rng):
    """That of grasps, of mixed steps and of rows of one's own, in either cone."""
    grasps = [drawn(rng, "grasp") for _ in range(3)]
    steps = [*grasps, *map(drawn, range(6)), *(SCENES[k] for k in SCENES if k[0] == "exact")]
    for step in steps:
        for name in (PYRAMID, ELLIPSOID):
            solution = solve_step(step.replace(cone=name))
            assert solution.net_impulse is not None
            assert verify(solution), verify(solution).reason
