"""The study of clouds, as quasistatic_ref/lab/clouds/clouds.toml has it.

    python -m validation.make.clouds

Adds the rows that are missing to validation/results/clouds.jsonl, one grasp a line. Ended runs go
on. ``--count N`` takes the first seeds only and prints the rows; nothing is written.
"""

from tqdm import tqdm

from quasistatic_ref.lab.clouds.study import Cell, cells, grid, row
from quasistatic_ref.lab.log import Log
from validation.tools.scripts import RESULTS, script_options

ROWS = RESULTS / "clouds.jsonl"


def main() -> None:
    """Grasp what was not yet grasped."""
    options = script_options(__doc__, count=int)
    names = list(Cell.__dataclass_fields__)
    path = None if options.count else ROWS
    log = Log(path, key=lambda one: Cell(*(one[name] for name in names)), head=grid())
    wanted = [one for one in cells() if not options.count or one.seed < options.count]
    drawn = ()
    for cell in tqdm(wanted):
        if cell in log.found:
            continue
        if drawn != (cell.sampling, cell.count, cell.seed):
            drawn = (cell.sampling, cell.count, cell.seed)
            cloud = cell.cloud()
        log.add(row(cell, cloud))
        if options.count:
            print(log.found[cell])


if __name__ == "__main__":
    main()
