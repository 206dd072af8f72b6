"""The study of second-order simulators: ``python -m validation.make.second_order``.

Takes the runs of validation/programs/engines/second_order.toml that are missing from
validation/results/second_order.jsonl, one a line, each engine in an environment of its own
(``--environments`` keeps them in a folder, and takes what is there). Ended runs go on.
``--count N`` takes the first N runs of each engine and prints them; nothing is written.
"""

import tempfile
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from tqdm import tqdm

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.log import Log
from validation.programs.engines.judge import program_of
from validation.programs.engines.phenomena import engine_answer
from validation.programs.engines.second_order import (
    STUDY,
    Motion,
    Run,
    closed_form,
    expected_motion,
    measures,
    motion,
    runs,
    scene_of,
)
from validation.programs.engines.second_order_page import ROWS, rows, tables
from validation.tools.scripts import script_options

TIMEOUT = 1200.0
"""For one run [s]."""


class Engines:
    """The programs of engines, each started when it is needed.

    Parameters
    ----------
    folder : Path
        Of their environments.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.started = ExitStack()
        self.programs = {}
        self.references = {}

    def answer(self, run: Run) -> dict[str, Any]:
        """Poses and processor time of a run."""
        if run.engine not in self.programs:
            program = program_of(run.engine, self.folder, TIMEOUT)
            self.programs[run.engine] = self.started.enter_context(program)
        setting = {"h": run.h, **STUDY["engines"][run.engine][run.setting]}
        program = self.programs[run.engine]
        return engine_answer(program, scene_of(run.scene, run.speed), setting)

    def reference(self, scene: str, speed: float) -> Motion:
        """What a run is compared with."""
        if closed_form(scene):
            return expected_motion(scene, scene_of(scene, speed))
        if (scene, speed) not in self.references:
            of = STUDY["reference"]
            poses = self.answer(Run(scene, speed, of["engine"], of["setting"], of["h"]))["poses"]
            self.references[scene, speed] = motion(scene_of(scene, speed), poses)
        return self.references[scene, speed]

    def row(self, run: Run) -> dict[str, Any]:
        """What is committed of a run; processor time a simulated second [ms]."""
        scene = scene_of(run.scene, run.speed)
        try:
            answer = self.answer(run)
            found = measures(scene, answer["poses"], self.reference(run.scene, run.speed))
        except ValueError as failed:
            return {**run._asdict(), "holds": False, "right": False, "failed": str(failed)}
        cost = 1e3 * answer["seconds"] / scene["times"][-1]
        return {**run._asdict(), **found, "cost": float(f"{cost:.3g}"), "failed": ""}


def main() -> None:
    """Take what was not yet taken."""
    given = script_options(__doc__, count=int, environments=Path)
    wanted = runs()
    if given.count:
        wanted = [
            run for name in STUDY["engines"]
            for run in [one for one in wanted if one.engine == name][: given.count]
        ]  # fmt: skip
    log = Log(
        None if given.count else ROWS,
        key=lambda one: Run(*(one[name] for name in Run._fields)),
        head=STUDY,
    )
    with tempfile.TemporaryDirectory() as temporary:
        engines = Engines((given.environments or Path(temporary)).absolute())
        with engines.started:
            for run in tqdm([one for one in wanted if one not in log.found]):
                log.add(engines.row(run))
                if given.count:
                    print(log.found[run])
    if not given.count:
        text_written(ROWS.with_suffix(".md"), tables(rows()))


if __name__ == "__main__":
    main()
