"""A hook of MkDocs: the notebook as a part of a page, with the outputs that are stored in it.

On a line of its own, ``<!-- cells of NAME.ipynb -->`` becomes the cells of the notebook beside the page.
Nothing is run, and what is shown is in the page itself.
"""

import json
import re
from pathlib import Path
from typing import Any

MARK = re.compile(r"^<!-- cells of ([\w-]+\.ipynb) -->$", re.MULTILINE)
STYLE = re.compile(r"<style.*?</style>", re.DOTALL)
FRAME = re.compile(r'<table border="\d" class="dataframe">')


def on_page_markdown(markdown: str, page: Any, **_: Any) -> str:
    """The page with the cells of the notebooks that it names."""
    folder = Path(page.file.abs_src_path).parent
    return MARK.sub(lambda at: cells(folder / at[1]), markdown)


def cells(notebook: Path) -> str:
    """A notebook as Markdown."""
    parts = []
    for cell in json.loads(notebook.read_text("utf-8"))["cells"]:
        source = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(source)
        elif cell["cell_type"] == "code":
            parts.append(f"```python\n{source}\n```")
            parts += [shown(output) for output in cell["outputs"]]
    return "\n\n".join(parts)


def shown(output: dict[str, Any]) -> str:
    """One output: a picture, a table, or text."""
    data = {kind: "".join(content) for kind, content in output.get("data", {}).items()}
    if picture := data.get("image/png"):
        address = f"data:image/png;base64,{picture.replace(chr(10), '')}"
        return f'<img alt="{data["text/plain"].strip("<>")}" src="{address}">'
    if table := data.get("text/html"):
        table = FRAME.sub("<table>", STYLE.sub("", table))
        return f'<div class="output">{" ".join(table.split())}</div>'
    text = data.get("text/plain") or "".join(output["text"])
    return f"``` {{.text .output}}\n{text.rstrip()}\n```"
