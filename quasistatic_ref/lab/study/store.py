"""The rows of a study: one Parquet file, written as a whole, that pandas and DuckDB ask."""

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any

from quasistatic_ref.errors import InputError
from quasistatic_ref.formats.files import written_whole
from quasistatic_ref.lab.study.row import Row, columns
from quasistatic_ref.parts import needed_package

ROWS = "rows.parquet"


def rows_written(path: Path, rows: Iterable[Row]) -> Path:
    """Write rows.

    Raises
    ------
    InputError
        If pyarrow is not installed, or the file cannot be written.
    """
    arrow, parquet = _parquet()
    kinds = {"string": arrow.string(), "int64": arrow.int64(), "bool": arrow.bool_(),
             "float64": arrow.float64()}  # fmt: skip
    schema = arrow.schema([(name, kinds[kind]) for name, kind in columns().items()])
    table = arrow.Table.from_pylist([asdict(row) for row in rows], schema=schema)
    return written_whole(path, lambda file: parquet.write_table(table, file, compression="zstd"))


def rows_read(folder: str | Path) -> list[Row]:
    """The rows of a study's folder, in the order in which they were measured.

    Raises
    ------
    InputError
        If there is no such file, or it is none of a study.
    """
    path = Path(folder) / ROWS
    arrow, parquet = _parquet()
    try:
        table = parquet.read_table(path)
    except (OSError, arrow.ArrowException) as error:
        words = str(error).partition("\n")[0][:120]
        raise InputError(f"holds no rows of a study: {words}", file=path) from None
    if table.column_names != list(columns()):
        raise InputError("has other columns than a study's rows", file=path)
    return [Row(**one) for one in table.to_pylist()]


def _parquet() -> tuple[Any, Any]:
    arrow = needed_package("pyarrow", "study", "the rows of a study")
    return arrow, needed_package("pyarrow.parquet", "study", "the rows of a study")
