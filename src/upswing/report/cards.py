"""Tables that become cards on a narrow screen: each cell then says itself which column it is of."""

import re

from markupsafe import Markup

HEAD = re.compile(r"<th\b[^>]*>(.*?)</th>", re.DOTALL)
ROW = re.compile(r"<tr\b.*?</tr>", re.DOTALL)
CELL = re.compile(r"<t([dh])\b([^>]*)>")
TAG = re.compile(r"<[^>]*>")


def cards(table: str) -> Markup:
    """A table of ours with the words of its column's head in every cell (``data-head``).

    Args:
        table: the table as HTML, with one row in its head, as a block of a template has it. A row that
            spans all columns stays as it is.
    """
    head, foot, body = str(table).partition("</thead>")
    heads = [
        " ".join(TAG.sub("", one).split()).replace('"', "&quot;") for one in HEAD.findall(head)
    ]
    return Markup(head + foot + ROW.sub(lambda row: _labelled(row[0], heads), body))  # noqa: S704


def _labelled(row: str, heads: list[str]) -> str:
    if "colspan" in row:
        return row
    columns = iter(heads)
    return CELL.sub(lambda cell: f'<t{cell[1]}{cell[2]} data-head="{next(columns, "")}">', row)
