"""Which steps are asked."""

from quasistatic_ref import Sphere
from quasistatic_ref.optional.doctor import asked
from tests.optional.doctor.words import free, scene, solid


def test_slips_that_are_rounding_choose_no_steps(monkeypatch):
    """Balls that are pushed and roll are asked after the first and the last step."""
    ball = solid(0.1, Sphere(0.01))
    bodies = {f"b{i}": free(ball, (0.1 * i, 0, 0.01), (0.5, 0, 0)) for i in range(8)}
    tables = {f"c{name}": ("floor", name, 0.5, 1, 0.01) for name in bodies}
    questions = []
    missing = asked.missing

    def noted(run, k, of, *cone):
        questions.append((k, len(of), *cone))
        return missing(run, k, of, *cone)

    monkeypatch.setattr(asked, "missing", noted)
    run = scene(bodies, tables, 10).run(progress=False)
    assert {finding.name for finding in run.findings} == {"equilibrium"}
    assert questions == [(0, 8), (9, 8), (0, 8, "ellipsoid")]
