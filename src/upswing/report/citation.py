"""How the project is cited: what the page takes from ``CITATION.cff``."""

from pathlib import Path
from typing import NamedTuple

from upswing.study.errors import BadInput
from upswing.study.yaml_file import read_yaml

FILE = "CITATION.cff"


class Citation(NamedTuple):
    """Who made it, when, and under which licence it may be used."""

    title: str
    authors: str
    version: str
    date: str  # of the release: yyyy-mm-dd
    license: str

    @property
    def bibtex(self) -> str:
        """The same for a list of references."""
        year, month = self.date.split("-")[:2]
        fields = {
            "title": f"{{{self.title}}}", "author": f"{{{self.authors}}}",
            "version": self.version, "year": year, "month": str(int(month)),
        }  # fmt: skip
        inner = ",\n".join(f"  {name} = {{{value}}}" for name, value in fields.items())
        return f"@software{{upswing,\n{inner}\n}}"


def citation(path: Path) -> Citation | None:
    """What a file in the Citation File Format says; None where there is none.

    Raises:
        BadInput: it lacks what the page shows.
    """
    if not path.exists():
        return None
    content = read_yaml(path)
    try:
        authors = " and ".join(
            one.get("name") or f"{one['given-names']} {one['family-names']}"
            for one in content["authors"]
        )
        return Citation(
            title=str(content["title"]), authors=authors, version=str(content["version"]),
            date=str(content["date-released"]), license=str(content["license"]),
        )  # fmt: skip
    except KeyError as error:
        raise BadInput([f"{path}: {error.args[0]}: missing, and the page shows it"]) from None
