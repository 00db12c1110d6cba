"""Indices of packages in a folder, with packages that are made up: what make would install from others."""

from hashlib import sha256
from pathlib import Path
from zipfile import ZipFile

BUILD = "Wheel-Version: 1.0\nGenerator: made-up\nRoot-Is-Purelib: true\nTag: py3-none-any\n"


def made_up_wheel(folder: Path, name: str, version: str, code: str) -> Path:
    """A wheel with one module, ``name``, that has this code."""
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{name}-{version}-py3-none-any.whl"
    about = f"{name}-{version}.dist-info"
    with ZipFile(path, "w") as wheel:
        wheel.writestr(f"{name}/__init__.py", code)
        wheel.writestr(
            f"{about}/METADATA", f"Metadata-Version: 2.1\nName: {name}\nVersion: {version}\n"
        )
        wheel.writestr(f"{about}/WHEEL", BUILD)
        wheel.writestr(f"{about}/RECORD", "")
    return path


def digits(path: Path) -> str:
    """The SHA-256 of a file."""
    return sha256(path.read_bytes()).hexdigest()


def made_up_index(folder: Path, *wheels: Path) -> str:
    """The address of an index that has these wheels, and tells their checksums."""
    for wheel in wheels:
        page = folder / wheel.name.split("-")[0] / "index.html"
        page.parent.mkdir(parents=True, exist_ok=True)
        before = page.read_text("utf-8") if page.exists() else ""
        link = f'<a href="{wheel.as_uri()}#sha256={digits(wheel)}">{wheel.name}</a>\n'
        page.write_text(before + link, "utf-8")
    return folder.as_uri()


def line(name: str, version: str, *wheels: Path) -> str:
    """A line of a lock file that allows these files."""
    return " \\\n    ".join(
        [f"{name}=={version}", *(f"--hash=sha256:{digits(each)}" for each in wheels)]
    )
