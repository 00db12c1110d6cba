"""What `make install` takes from an index: torch for a CPU wherever there is one, and only what was locked.

The indices and their packages are made up, so nothing is fetched. The folder of the checkout has blanks and
other letters in its path, the home cannot be written, and the encoding is ASCII.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

from tests.paths import ROOT
from tests.portability.indices import line, made_up_index, made_up_wheel

pytestmark = pytest.mark.heavy  # it makes environments

FOR_A_GPU = "import gpulib\nbuild = 'gpu'\n"
SAID = "This torch needs gigabytes of GPU libraries"


@pytest.fixture
def have(tmp_path):
    """Wheels, and a checkout whose lock files have them: torch in two builds, and a library for a GPU."""
    wheels = tmp_path / "wheels"
    cpu = made_up_wheel(wheels / "cpu", "torch", "2.0.0+cpu", "build = 'cpu'\n")
    gpu = made_up_wheel(wheels, "torch", "2.0.0", FOR_A_GPU)
    library = made_up_wheel(wheels, "gpulib", "1.0", "")
    other = made_up_wheel(wheels, "other", "3.0", "")
    checkout = tmp_path / "with blanks, and Übung Δφ"
    checkout.mkdir()
    shutil.copy(ROOT / "Makefile", checkout)
    (checkout / "requirements.lock").write_text(
        f"# A comment.\n{line('other', '3.0', other)}\n{line('torch', '2.0.0', cpu, gpu)}\n",
        "utf-8",
    )
    (checkout / "requirements-gpu.lock").write_text(line("gpulib", "1.0", library) + "\n", "utf-8")
    (checkout / "requirements-slurm.lock").write_text(line("other", "3.0", other) + "\n", "utf-8")
    index = made_up_index(tmp_path / "index", gpu, library, other)
    return SimpleNamespace(
        cpu=cpu, gpu=gpu, other=other, index=index, checkout=checkout, folder=tmp_path
    )


def install(have, **settings: str) -> subprocess.CompletedProcess[str]:
    """Make what `make install` makes before upswing itself, with these settings of pip."""
    kept = {key: text for key, text in os.environ.items() if not key.startswith("PIP_")}
    surroundings = {
        **kept, "HOME": "/proc", "LC_ALL": "C", "LANG": "C", "XDG_CACHE_HOME": "/proc/cache",
        "PIP_CONFIG_FILE": os.devnull, "PIP_INDEX_URL": have.index, **settings,
    }  # fmt: skip
    return subprocess.run(
        ["make", f"PYTHON={sys.executable}", ".venv/.locked"],
        cwd=have.checkout, env=surroundings, capture_output=True, text=True, check=False,
    )  # fmt: skip


def installed(have, code: str) -> str:
    """What code prints in the environment that was made."""
    python = have.checkout / ".venv/bin/python"
    done = subprocess.run([python, "-c", code], capture_output=True, text=True, check=True)
    return done.stdout.strip()


def has(have, name: str) -> bool:
    return (
        installed(have, f"from importlib.util import find_spec; print(find_spec('{name}'))")
        != "None"
    )


@pytest.mark.parametrize("where", ["in a folder", "in another index"])
def test_torch_for_a_cpu_is_taken_wherever_there_is_one(have, where):
    more = made_up_index(have.folder / "more", have.cpu)
    settings = (
        {"PIP_FIND_LINKS": str(have.cpu.parent)}
        if where == "in a folder"
        else {"PIP_EXTRA_INDEX_URL": more}
    )
    done = install(have, **settings)
    assert done.returncode == 0, done.stdout + done.stderr
    assert installed(have, "import torch; print(torch.build)") == "cpu"
    assert not has(have, "gpulib")
    assert SAID not in done.stderr
    assert {path.name for path in (have.checkout / ".venv/slurm").iterdir()} >= {"other"}


def test_elsewhere_torch_comes_with_what_it_cannot_be_imported_without_and_that_is_said(have):
    done = install(have)
    assert done.returncode == 0, done.stdout + done.stderr
    assert installed(have, "import torch; print(torch.build)") == "gpu"
    assert SAID in done.stderr


@pytest.mark.parametrize("name", ["torch", "other"])
def test_a_file_with_another_checksum_is_not_installed(have, name):
    wheel = have.gpu if name == "torch" else have.other
    made_up_wheel(
        wheel.parent, name, wheel.name.split("-")[1], "raise SystemExit('tampered with')\n"
    )
    shutil.rmtree(have.folder / "index")
    made_up_index(have.folder / "index", *Path(have.gpu.parent).glob("*.whl"))
    done = install(have)
    assert done.returncode != 0
    assert "DO NOT MATCH THE HASHES" in done.stderr
    assert not (have.checkout / ".venv/.locked").exists()
    assert not has(have, name)


def test_a_line_without_a_checksum_is_not_installed(have):
    (have.checkout / "requirements-slurm.lock").write_text("other==3.0\n", "utf-8")
    done = install(have)
    assert done.returncode != 0
    assert "--require-hashes" in done.stderr
