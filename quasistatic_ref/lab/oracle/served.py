"""Steps that another program asks for, and the scenes that they are of."""

import json
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from quasistatic_ref.certify.solution_files import solution_text
from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.quoting import suggestion
from quasistatic_ref.formats.resources import models_folder, scenario_path
from quasistatic_ref.formats.table_reader import REQUIRED, TableReader
from quasistatic_ref.scenario.paths import lies_in
from quasistatic_ref.scenario.scenario import Scenario, load_scenario
from quasistatic_ref.simulate.result import StepResult
from quasistatic_ref.simulate.simulator import Simulator
from quasistatic_ref.step.files import step_text


class Served(NamedTuple):
    """A scene that steps are asked of.

    Parameters
    ----------
    scenario : Scenario
    simulator : Simulator
        Serves all steps.
    """

    scenario: Scenario
    simulator: Simulator

    @property
    def record(self) -> dict[str, Any]:
        """What a client has to know: the order of what it sends and gets."""
        system = self.scenario.system
        return {
            "h": self.scenario.h,
            "q": [p.name for joint in system.joints for p in joint.positions],
            "n_q_a": system.n_q_a,
            "delta_q": [coordinate.name for coordinate in system.coordinates],
            "contacts": list(self.simulator.layout.slots),
            "q_start": system.q_start.tolist(),
        }


def contact_records(result: StepResult) -> list[dict[str, Any]]:
    """Each contact of a step: its name, gap, points and normal before the step."""
    k = result.step.contacts
    points = result.points
    return [
        {"name": k.name[j], "phi": float(k.phi[j]), "alpha": points.alpha[j].tolist(),
         "beta": points.beta[j].tolist(), "n": k.n[j].tolist()}
        for j in range(k.n_c)
    ]  # fmt: skip


ANSWERS: Mapping[str, Callable[[StepResult], Any]] = {
    "q": lambda result: result.q.tolist(),
    "delta_q": lambda result: result.solution.delta_q.tolist(),
    "forces": lambda result: result.forces.tolist(),
    "wrench": lambda result: result.solution.wrench.tolist(),
    "certificate": lambda result: result.solution.certificate.kind,
    "contacts": contact_records,
    "step": lambda result: json.loads(step_text(result.step)),
    "solution": lambda result: json.loads(solution_text(result.solution)),
}
"""What may be asked of a step; ``forces`` take longer than the step."""
DEFAULT_WORDS = ("q", "forces", "certificate")


class Scenes:
    """The scenes of one client, by name.

    Parameters
    ----------
    settings : list of str
        Changes of every scene, as :func:`~quasistatic_ref.scenario.scenario.load_scenario` takes
        them.
    roots : sequence of str or Path
        Folders from which a client may name files, beside the working folder.
    """

    def __init__(self, settings: list[str], roots: Sequence[str | Path] = ()) -> None:
        self._settings = settings
        self._folders = [Path.cwd(), models_folder(), *map(Path, roots)]
        self.by_name: dict[str, Served] = {}

    def add(self, scene: str | dict[str, Any], name: str | None = None) -> str:
        """Load a scene from a file, by its name, or from a client's tables; its name here.

        Raises
        ------
        InputError
            As of :func:`~quasistatic_ref.scenario.scenario.load_scenario`.
        """
        scenario = load_scenario(scene, self._settings, of_others=True)
        name = scenario.path.stem if name is None else name
        self.by_name[name] = Served(scenario, scenario.simulator())
        return name

    def scene_named(self, name: str | None) -> Served:
        """The scene of that name, or the only one; InputError if there is none."""
        if name is None and len(self.by_name) == 1:
            (name,) = self.by_name
        if name is None:
            raise InputError("is missing: there is not one scene alone", field="scene")
        if name not in self.by_name:
            problem = f"is not a scene here{suggestion(name, self.by_name)}"
            raise InputError(problem, field="scene", value=name)
        return self.by_name[name]

    def answer(self, request: TableReader) -> dict[str, Any]:
        """What is answered to one request, which sends a scene or asks for a step.

        Raises
        ------
        QuasistaticError
        """
        for field in ("file", "tables"):
            if field in request:
                name = request.text("scene", None)
                sent = request.take(field)
                if not isinstance(sent, str if field == "file" else dict):
                    words = "a path or a name" if field == "file" else "the tables of a scenario"
                    raise request.error_about(field, f"must be {words}", sent)
                request.close()
                if isinstance(sent, str) and not lies_in(scenario_path(sent), self._folders):
                    problem = "is outside of the folder that is served; serve with --root FOLDER"
                    raise request.error_about(field, problem, sent)
                name = self.add(sent, name)
                return {"scene": name, **self.by_name[name].record}
        one = self.scene_named(request.text("scene", None))
        system = one.scenario.system
        request.only(("q", "target", "force", "ask"))
        items = request.words("ask", list(DEFAULT_WORDS))
        for what in items:
            if what not in ANSWERS:
                raise request.error_about("ask", f"is unknown{suggestion(what, ANSWERS)}", what)
        q = request.array("q", (system.n_q,))
        target = request.array("target", (system.n_q_a,), REQUIRED if system.n_q_a else [])
        force = request.array("force", (system.n_v,), [0.0] * system.n_v)
        result = one.simulator.step(q, target, force)
        return {what: ANSWERS[what](result) for what in items}
