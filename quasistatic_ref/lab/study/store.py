"""The rows of a study: one Parquet file, written as a whole, that pandas reads."""

from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path
from typing import Any, get_args, get_type_hints

from quasistatic_ref.errors import InputError
from quasistatic_ref.lab.study.row import Row, key_of
from quasistatic_ref.parts import needed_package
from quasistatic_ref.text.content import written_whole

ROWS = "rows.parquet"
COLUMNS = get_type_hints(Row)
"""Name -> type, or a union of one with None."""


def rows_written(path: Path, rows: Iterable[Row]) -> Path:
    """Write rows.

    Raises
    ------
    InputError
        If pyarrow is not installed, or the file cannot be written.
    """
    arrow, parquet = _parquet()
    kinds = {str: arrow.string(), int: arrow.int64(), bool: arrow.bool_(), float: arrow.float64()}
    schema = arrow.schema(
        [(name, kinds[(get_args(kind) or (kind,))[0]]) for name, kind in COLUMNS.items()]
    )
    table = arrow.Table.from_pylist([asdict(row) for row in rows], schema=schema)
    return written_whole(path, lambda file: parquet.write_table(table, file, compression="zstd"))


def rows_read(folder: str | Path) -> list[Row]:
    """The rows of a study's folder, in the order in which they were measured, each once.

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
    if table.column_names != list(COLUMNS):
        raise InputError("has other columns than a study's rows", file=path)
    rows = [Row(**one) for one in table.to_pylist()]
    return list({key_of(row): row for row in rows}.values())


def _parquet() -> list[Any]:
    names = ("pyarrow", "pyarrow.parquet")
    return [needed_package(name, "study", "the rows of a study") for name in names]
