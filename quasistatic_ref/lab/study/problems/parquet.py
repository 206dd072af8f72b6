"""A study's problems as test sets of qpbenchmark, in raw and in natural units."""

from pathlib import Path

from quasistatic_ref.formats.files import text_written
from quasistatic_ref.lab.study.problems.qp import UNITS, Problem, Truth, units_of
from quasistatic_ref.lab.study.problems.study_problems import problems_read
from quasistatic_ref.lab.vectors.parquet import Program, npz_written, parquet_written
from quasistatic_ref.solve.units import natural_form


def benchmark_written(store: str | Path, folder: str | Path, every: int = 1) -> list[Path]:
    """Write parquet, module and exact answers for each of the units.

    Parameters
    ----------
    store : str or Path
        Folder of a study that was run.
    folder : str or Path
    every : int
        Each N-th problem only.

    Returns
    -------
    list of Path

    Raises
    ------
    InputError
        If there are no problems, pyarrow is missing, or the folder cannot be written.
    """
    problems, paths = problems_read(store)[::every], []
    problems = [problem for problem in problems if isinstance(problem.answer, Truth)]
    template = (Path(__file__).parent / "test_set.txt").read_text(encoding="utf-8")
    for units in UNITS:
        name = f"contact_{units}"
        programs = [_program(problem, units) for problem in problems]
        module = template.format(name=name, units=units, title=name.title().replace("_", ""))
        paths += [
            parquet_written(Path(folder) / f"{name}.parquet", programs),
            npz_written(Path(folder) / f"{name}.npz", programs),
            text_written(Path(folder) / f"{name}.py", module),
        ]
    return paths


def _program(problem: Problem, units: str) -> Program:
    assert isinstance(problem.answer, Truth)  # as those are that are chosen
    form, delta_q = problem.form, problem.answer.delta_q
    if units == "natural":
        own = units_of(form)
        form, delta_q = natural_form(form, own), delta_q / (own.size * own.coordinate)
    return Program(problem.id, form.H, form.g, form.A, form.b, delta_q)
