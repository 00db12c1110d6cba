"""Reading a table: a Parquet file of whatever origin has the columns asked for, or one line says not."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import pyarrow as pa
import pyarrow.parquet as pq

from upswing.study.errors import BadInput, near

if TYPE_CHECKING:
    import pandas as pd

Columns = Mapping[str, str]
"""What each column holds: ``text``, ``number``, ``whole``, ``truth`` or ``texts``.

With ``?`` behind it a row may have none; a number always may, because NaN is stored as none.
"""


def _is_text(kind: pa.DataType) -> bool:
    return bool(pa.types.is_string(kind) or pa.types.is_large_string(kind))


def _is_number(kind: pa.DataType) -> bool:
    return bool(pa.types.is_floating(kind) or pa.types.is_integer(kind))


def _is_texts(kind: pa.DataType) -> bool:
    of_list = pa.types.is_list(kind) or pa.types.is_large_list(kind)
    return of_list and (_is_text(kind.value_type) or pa.types.is_null(kind.value_type))


HOLDS: dict[str, Callable[[pa.DataType], bool]] = {
    "text": _is_text,
    "number": _is_number,
    "whole": pa.types.is_integer,
    "truth": pa.types.is_boolean,
    "texts": _is_texts,
}


def read_table(path: Path, columns: Columns, remedy: str, *, empty: bool = False) -> "pd.DataFrame":
    """The table in a file, with all columns that it has.

    Args:
        path: the file.
        columns: what it must have.
        remedy: what to do where it is missing or another: ``upswing tables results``, for example.
        empty: whether it may have no rows.

    Raises:
        BadInput: it is missing, cannot be read, or is another table; all that is wrong with it.
    """
    if not path.is_file():
        raise BadInput([f"{path}: missing; {remedy}"])
    try:
        table = pq.read_table(path)
        frame: pd.DataFrame = table.to_pandas()
    except (OSError, pa.ArrowException, ValueError, TypeError, KeyError) as error:
        said = str(error).splitlines() or [type(error).__name__]
        raise BadInput([f"{path}: cannot be read: {said[0]}; {remedy}"]) from None
    if wrong := _wrong(table, columns, empty=empty):
        raise BadInput([f"{path}: is no such table: {'; '.join(wrong[:3])}; {remedy}"])
    return frame


def _wrong(table: pa.Table, columns: Columns, *, empty: bool) -> list[str]:
    names = table.column_names
    if len(set(names)) < len(names):
        return ["it has two columns of one name"]
    if missing := [name for name in columns if name not in names]:
        return [f"it has no column {', '.join(missing[:3])} ({near(missing[0], names)[:120]})"]
    wrong = []
    for name, kind in columns.items():
        column, word = table[name], kind.removesuffix("?")
        may_lack = kind.endswith("?") or word == "number"
        if may_lack and pa.types.is_null(column.type):
            continue
        if len(column) and not HOLDS[word](column.type):
            wrong.append(f"column {name} holds {column.type}, not {word}")
        elif column.null_count and not may_lack:
            wrong.append(f"column {name} is empty in {column.null_count} rows")
    if not len(table) and not empty:
        wrong.append("it has no rows")
    return wrong
