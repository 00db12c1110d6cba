"""Where it runs: what the lock files have, against what the index in use has; and what is said of it."""

import re
import shutil
import subprocess
import sys
from importlib.metadata import distribution
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml
from packaging.markers import Marker

from tests.paths import ROOT
from tests.portability import lock, page
from tests.portability.lock import GPU, LOCK, SLURM, UV, Pin, pins, uv, with_cpu_builds
from tests.portability.wheels import PLATFORMS, PYTHONS, File, Fit, Line, fitting, lines, wanted

pytestmark = pytest.mark.heavy  # it asks an index about every line of the locks

LOCKS = (LOCK, SLURM, GPU)
LINUX, ARM, MACOS = PLATFORMS
FOR_UV = {
    LINUX.name: "x86_64-manylinux_2_28",
    ARM.name: "aarch64-manylinux_2_28",
    MACOS.name: "aarch64-apple-darwin",
}


@pytest.fixture(scope="module")
def index():
    """The lines of all lock files, as the index in use has them."""
    try:
        uv("pip", "compile", "-", "--no-deps", given="packaging")
    except SystemExit as problem:
        pytest.skip(f"no index of packages: {problem}")
    return SimpleNamespace(
        **{name: lines(getattr(lock, name)) for name in ("LOCK", "SLURM", "GPU")}
    )


def test_the_table_of_the_documentation_is_what_the_index_has(index):
    assert page.table() == page.stored()


def resolved_by_uv(platform, python, *arguments: str) -> set[str]:
    """The lines that uv finds there, from wheels only unless an argument excepts one."""
    options = [
        "--python-platform",
        FOR_UV[platform.name],
        "--python-version",
        ".".join(map(str, python)),
    ]
    found = uv("pip", "compile", "--no-deps", "--only-binary", ":all:", *options, *arguments)
    return {pin.name for pin in pins(found)}


@pytest.mark.heavy
@pytest.mark.parametrize("python", PYTHONS, ids=lambda python: ".".join(map(str, python)))
@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda platform: platform.name)
def test_every_line_is_resolved_as_the_table_says(index, monkeypatch, platform, python):
    monkeypatch.setenv("MACOSX_DEPLOYMENT_TARGET", "14.0")
    pinned = wanted([*index.LOCK, *index.SLURM, *index.GPU], platform, python)
    built = [line.name for line in pinned if fitting(line, platform, python) is None]
    excepted = [part for name in built for part in ("--no-binary", name)]
    found = resolved_by_uv(platform, python, *map(str, LOCKS), *excepted)
    assert found == {line.name for line in pinned}


def test_what_is_said_to_be_built_has_no_wheel_for_uv_either(index, tmp_path):
    newest = PYTHONS[-1]
    built = [
        line.name
        for line in index.LOCK
        if fitting(line, LINUX, newest) is None and line in wanted([line], LINUX, newest)
    ]
    assert built
    for pin in pins(LOCK.read_text("utf-8")):
        if pin.name in built:
            (tmp_path / "one.txt").write_text(pin.required, "utf-8")
            with pytest.raises(SystemExit, match="wheel"):
                resolved_by_uv(LINUX, newest, str(tmp_path / "one.txt"))


def test_the_lock_files_have_all_that_the_project_needs_and_torch_for_a_gpu_besides(index):
    known = [pin for path in LOCKS for pin in pins(path.read_text("utf-8"))]
    needed = lock.resolved(("dev", "docs", "slurm"), known)
    assert {pin.required for pin in needed} == {pin.required for pin in known}
    assert {pin.name for pin in pins(GPU.read_text("utf-8"))} > {"triton"}


@pytest.mark.parametrize("name", ["LOCK", "SLURM", "GPU"])
def test_the_checksums_allow_every_file_that_the_index_has(index, name):
    ours: dict[str, set[str]] = {}
    for pin in pins(getattr(lock, name).read_text("utf-8")):
        ours.setdefault(pin.name, set()).update(pin.checksums)
    theirs = {line.name: line.checksums for line in getattr(index, name)}
    assert ours.keys() == theirs.keys()
    assert {each: found - ours[each] for each, found in theirs.items() if found - ours[each]} == {}


@pytest.mark.parametrize("path", LOCKS, ids=lambda path: path.stem)
def test_a_lock_file_has_versions_and_checksums_and_no_addresses(path):
    text = path.read_text("utf-8")
    found = pins(text)
    assert found
    for pin in found:
        (version,) = pin.requirement.specifier
        assert version.operator == "=="
        assert pin.checksums
        assert all(re.fullmatch(r"sha256:[0-9a-f]{64}", each) for each in pin.checksums)
    assert "://" not in text
    assert not re.search(r"^\s*--(?!hash)", text, re.MULTILINE)
    comments = "".join(f"{each}\n" for each in text.splitlines() if each.startswith("#"))
    assert comments + "".join(f"{pin}\n" for pin in found) == text


def test_no_line_is_for_a_gpu_but_those_apart():
    for path in (LOCK, SLURM):
        assert not [
            pin.name for pin in pins(path.read_text("utf-8")) if lock.FOR_A_GPU.match(pin.name)
        ]


def test_what_is_built_on_every_platform_needs_no_compiler():
    on_every = set.intersection(
        *(set(re.findall(r"`([\w-]+)`", row)) for row in page.stored().splitlines()[2:6])
    )
    assert on_every == {"connection-pool"}
    for name in on_every:
        assert "Root-Is-Purelib: true" in distribution(name).read_text("WHEEL")


WHEELS = [
    ("a-1-py3-none-any.whl", LINUX, (3, 14), ()),
    ("a-1-py2.py3-none-any.whl", MACOS, (3, 11), ()),
    ("a-1-cp312-cp312-manylinux_2_27_x86_64.manylinux_2_28_x86_64.whl", LINUX, (3, 12), (2, 27)),
    ("a-1-cp312-cp312-manylinux2014_x86_64.whl", LINUX, (3, 12), (2, 17)),
    ("a-1-cp312-cp312-manylinux2014_x86_64.whl", LINUX, (3, 13), None),
    ("a-1-cp312-cp312-manylinux2014_x86_64.whl", ARM, (3, 12), None),
    ("a-1-cp39-abi3-manylinux_2_28_aarch64.whl", ARM, (3, 13), (2, 28)),
    ("a-1-cp314-abi3-manylinux_2_28_aarch64.whl", ARM, (3, 13), None),
    ("a-1-cp313-cp313t-macosx_14_0_arm64.whl", MACOS, (3, 13), None),
    ("a-1-cp313-none-macosx_14_0_arm64.whl", MACOS, (3, 13), (14, 0)),
    ("a-1-py3-none-macosx_10_9_universal2.whl", MACOS, (3, 11), (10, 9)),
    ("a-1-py3-none-macosx_10_9_x86_64.whl", MACOS, (3, 11), None),
    ("a-1-cp311-cp311-musllinux_1_2_x86_64.whl", LINUX, (3, 11), None),
    ("a-1-cp311-cp311-win_amd64.whl", LINUX, (3, 11), None),
    ("a-1%2Bcpu-cp311-cp311-manylinux_2_28_x86_64.whl", LINUX, (3, 11), (2, 28)),
]  # fmt: skip


@pytest.mark.parametrize(("name", "platform", "python", "needs"), WHEELS)
def test_a_wheel_fits_where_its_name_says(name, platform, python, needs):
    line = Line("a", None, (File(name, 7),), frozenset())
    assert fitting(line, platform, python) == (None if needs is None else Fit(needs, 7))


def test_the_wheel_for_the_oldest_system_is_counted():
    files = (
        File("a-1-py3-none-manylinux_2_28_x86_64.whl", 1),
        File("a-1-py3-none-manylinux1_x86_64.whl", 2),
    )
    assert fitting(Line("a", None, files, frozenset()), LINUX, (3, 11)) == Fit((2, 5), 2)


def test_a_marker_chooses_the_lines():
    found = [
        Line("all", None, (), frozenset()),
        Line("mac", Marker("sys_platform == 'darwin'"), (), frozenset()),
        Line("old", Marker("python_full_version < '3.12'"), (), frozenset()),
        Line("arm", Marker("platform_machine == 'aarch64'"), (), frozenset()),
    ]
    assert [line.name for line in wanted(found, MACOS, (3, 12))] == ["all", "mac"]
    assert [line.name for line in wanted(found, ARM, (3, 11))] == ["all", "old", "arm"]


def test_another_torch_needs_an_index_that_has_it_for_a_cpu():
    known = {"torch": Pin("torch==2.0.0", ("sha256:cpu", "sha256:gpu"))}
    same = with_cpu_builds(Pin("torch==2.0.0", ("sha256:gpu",)), known, "")
    assert same.checksums == ("sha256:cpu", "sha256:gpu")
    with pytest.raises(SystemExit, match=r"torch==2\.1\.0 is new: .*make lock CPU_BUILDS=ADDRESS"):
        with_cpu_builds(Pin("torch==2.1.0", ("sha256:new",)), known, "")


def test_uv_runs_what_make_installed_and_changes_nothing(tmp_path):
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    (tmp_path / ".venv").symlink_to(sys.prefix)
    (tmp_path / "src").symlink_to(ROOT / "src")
    done = subprocess.run(
        [UV, "run", "--offline", "python", "-c", "import upswing, sys; print(sys.prefix)"],
        cwd=tmp_path, env={"HOME": "/proc", "PATH": "/usr/bin:/bin", "UV_CACHE_DIR": str(tmp_path / "uv")},
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert Path(done.stdout.strip()).resolve() == Path(sys.prefix).resolve()
    assert not (tmp_path / "uv.lock").exists()


def test_continuous_integration_runs_every_python_of_the_table():
    jobs = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text("utf-8"))["jobs"]
    assert jobs["test"]["strategy"]["matrix"]["python"] == [
        ".".join(map(str, each)) for each in PYTHONS
    ]


def test_the_container_is_made_from_the_lock_files_that_there_are():
    recipe = (ROOT / "Dockerfile").read_text("utf-8")
    python = re.search(r"^ARG PYTHON=(\d+)\.(\d+)$", recipe, re.MULTILINE)
    assert tuple(map(int, python.groups())) in PYTHONS
    copied = [
        word
        for args in re.findall(r"^COPY (.+) \./?$", recipe, re.MULTILINE)
        for word in args.split()
    ]
    assert {path.name for path in LOCKS} <= set(copied)
    assert all((ROOT / name).exists() for name in copied)
    targets = re.findall(r"\bmake ([\w./-]+)", recipe)
    makefile = (ROOT / "Makefile").read_text("utf-8").replace("$(VENV)", ".venv")
    assert targets
    assert all(re.search(rf"^{re.escape(target)}:", makefile, re.MULTILINE) for target in targets)
