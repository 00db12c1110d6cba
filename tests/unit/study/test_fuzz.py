"""Bad input in quantity: whatever is written, the answer is a study or one message that names the key."""

import contextlib
import copy
import json
import re
import time
from pathlib import Path

import pytest
import yaml
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.helpers import make_spec
from upswing.cli.main import main
from upswing.study.claims import load_claims
from upswing.study.config import load, validated
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.measured import MEASURES
from upswing.study.results_folder import check_results
from upswing.study.spec import parse
from upswing.study.sweeps import groups, load_sweeps
from upswing.study.yaml_file import read_yaml

pytestmark = pytest.mark.heavy  # it tries thousands of malformed files

MANY = settings(
    max_examples=1_000, deadline=None, suppress_health_check=list(HealthCheck), derandomize=True
)
SOME = settings(MANY, max_examples=500)
FEW = settings(MANY, max_examples=200)
VALID = read_yaml(Path("config/config.yaml"))
SPEC = json.loads(make_spec("full-control", "modular-networks-5", 0.5).canonical())

TRICKS = [
    "../../etc/passwd", "/etc/passwd", "..", ".", "", " ", "a/b", "a b", "$(touch x)", "`id`", "; rm -rf x",
    "'", '"', "\n", "\x00", "ﬁ", "😀", "a" * 10_000, "{seed}", "{{x}}", "%s", "<script>", "CON", "-rf", "NaN",
]  # fmt: skip
numbers = st.one_of(
    st.integers(-(10**30), 10**30), st.floats(), st.just(float("nan")), st.just(float("inf"))
)
scalars = st.one_of(
    st.none(), st.booleans(), numbers, st.sampled_from(TRICKS), st.text(max_size=20)
)
anything = st.recursive(
    scalars,
    lambda inner: st.one_of(
        st.lists(inner, max_size=4),
        st.dictionaries(st.one_of(st.sampled_from(TRICKS), st.text(max_size=8)), inner, max_size=4),
    ),
    max_leaves=12,
)


def places(value, place=()):
    """Every place in a value, the value itself included."""
    yield place
    parts = (
        value.items()
        if isinstance(value, dict)
        else enumerate(value)
        if isinstance(value, list)
        else ()
    )
    for key, part in parts:
        yield from places(part, (*place, key))


@st.composite
def malformed(draw, valid):
    """A valid value in which something was replaced, added, removed or renamed; and the top key of it."""
    value = copy.deepcopy(valid)
    place = draw(st.sampled_from([p for p in places(valid) if p]))
    parent = value
    for key in place[:-1]:
        parent = parent[key]
    last = place[-1]
    what = draw(st.sampled_from(["replace", "remove", "add", "rename"]))
    if what == "replace" or isinstance(parent, list):
        parent[last] = draw(anything)
    elif what == "remove":
        del parent[last]
    elif what == "add":
        parent[draw(st.sampled_from(TRICKS))] = draw(anything)
    else:
        parent[draw(st.sampled_from(TRICKS))] = parent.pop(last)
    return value


ONE_LINE = re.compile(r"mine\.yaml: [^\n\r\x00]{1,1000}")


@MANY
@given(malformed(VALID))
def test_a_malformed_configuration_is_a_study_or_one_message_naming_keys(content):
    try:
        study = validated({"mine.yaml": content})
    except BadInput as problem:
        wrong = [line for line in problem.problems if not ONE_LINE.fullmatch(line)]
        assert problem.problems  # noqa: PT017
        assert wrong == []
        return
    for run in Matrix(study).runs:  # nothing in it leaves the folder of results or breaks a command
        assert re.fullmatch(r"[a-z0-9-]+/[a-z0-9-]+/alpha-([0-9.]+|none)/seed-\d+", run)


@MANY
@given(malformed(SPEC))
def test_a_malformed_specification_is_a_spec_or_one_message(content):
    try:
        spec = parse(json.dumps(content))
    except BadInput as problem:
        wrong = [line for line in problem.problems if not line.startswith("spec: ")]
        assert wrong == []
        return
    assert re.fullmatch(r"[a-z0-9-]+/[a-z0-9-]+/alpha-([0-9.]+|none)", spec.cell)


def one_message_or(read, path, content):
    """What ``read`` makes of a file with ``content``; None after one message whose lines are short."""
    path.write_text(yaml.safe_dump(content, allow_unicode=True), "utf-8")
    try:
        return read(path)
    except BadInput as problem:
        wrong = [line for line in problem.problems if not ONE_LINE.fullmatch(line.replace(f"{path.parent}/", ""))]  # fmt: skip
        assert problem.problems  # noqa: PT017
        assert wrong == []
        return None


CLAIMS = read_yaml(Path("config/claims.yaml"))
READINGS = read_yaml(Path("config/readings.yaml"))
STUDY = load(Path("config/config.yaml"))
CELLS = Matrix(STUDY).cells
SAFE = re.compile(r"[A-Za-z0-9-]+")


@SOME
@given(content=malformed(CLAIMS))
def test_malformed_claims_are_claims_or_one_message(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "mine.yaml"
    claims = one_message_or(lambda path: load_claims(path, STUDY), path, content)
    for name, claim in (claims or {}).items():
        assert SAFE.fullmatch(name)
        for part in claim.parts:  # each can be judged: its cells and its measures are there
            assert all(cell in CELLS for cells in part.comparisons for cell in cells)
            assert {*part.where, *part.among, *([part.measure] if part.measure else [])} <= set(MEASURES)  # fmt: skip


@SOME
@given(content=malformed(READINGS))
def test_malformed_sweeps_are_sweeps_or_one_message(tmp_path_factory, content):
    path = tmp_path_factory.getbasetemp() / "mine.yaml"
    sweeps = one_message_or(lambda path: load_sweeps(path, STUDY), path, content)
    for name, sweep in (sweeps or {}).items():
        assert SAFE.fullmatch(name)
        for group in groups(sweep, STUDY):  # each is a file's name and a word of a command
            assert re.fullmatch(r"[A-Za-z0-9._-]+", group.name)


PIECES = st.sampled_from([*TRICKS, "src", ".git", "file", "loop", "own", "tables", "new", "~", "é"])
folders = st.one_of(
    st.text(max_size=20),
    st.lists(PIECES, min_size=1, max_size=4).map("/".join),
    st.sampled_from(TRICKS),
)


@SOME
@given(folder=folders, title=st.one_of(st.text(max_size=20), st.sampled_from(TRICKS)))
def test_any_folder_is_fit_for_results_or_one_message_and_nothing_is_made(
    tmp_path_factory, folder, title
):
    """A folder that is accepted is below the one it is run in, and none of the project's own."""
    home = tmp_path_factory.getbasetemp() / "project"
    for name in ("src/upswing", ".git", "own"):
        (home / name).mkdir(parents=True, exist_ok=True)
    (home / "file").touch()
    (home / "own/study.json").touch()
    if not (home / "loop").is_symlink():
        (home / "loop").symlink_to("loop")
    before = sorted(home.rglob("*"))
    experiments = [{**VALID["experiments"][0], "title": title}]
    content = {**VALID, "results": folder, "experiments": experiments}
    with contextlib.chdir(home):
        try:
            study = validated({"mine.yaml": content})
            check_results(study.results, "mine.yaml")
        except BadInput as problem:
            wrong = [line for line in problem.problems if not ONE_LINE.fullmatch(line)]
            assert wrong == []
        else:
            place = Path(folder).resolve()
            assert not home.is_relative_to(place)
            assert not folder.startswith(("-", "~"))
            for name in ("src", ".git", "file", "own/tables"):
                assert not place.is_relative_to(home / name)
            assert "\x00" not in study.experiments[0].title
    assert sorted(home.rglob("*")) == before


@FEW
@given(st.one_of(st.text(max_size=200), st.binary(max_size=200), anything.map(yaml.safe_dump)))
def test_any_file_is_a_study_or_one_message(tmp_path_factory, content):
    path = tmp_path_factory.mktemp("fuzz") / "mine.yaml"
    path.write_bytes(content if isinstance(content, bytes) else content.encode("utf-8", "replace"))
    with pytest.raises(BadInput) as caught:
        load(path)
    assert "mine.yaml" in str(caught.value)


@pytest.mark.parametrize(
    "text",
    [
        "a: " + "[" * 5_000,
        "a: " + "{b: " * 2_000,
        "a: &x [*x]",
        "a: &a [1]\nb: &b [*a, *a]\nc: [*b, *b]",
        "!!python/object/apply:os.system ['touch pwned']",
        "a: !!binary x",
        "? [1, 2]\n: 3",
        "%YAML 9.9\n---\n",
        "a: 2001-13-45",
        "a: !!int x",
        "a: !!bool perhaps",
        "a: " + "9" * 5_000,
        "a0: &a0 {x: 1}\n"
        + "\n".join(f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}]}}" for n in range(1, 60)),
    ],
)
def test_hostile_yaml_is_one_message_in_time_and_runs_nothing(tmp_path, text, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("mine.yaml").write_text(text, "utf-8")
    begin = time.process_time()
    assert main(["check", "mine.yaml"]) == 2
    assert time.process_time() - begin < 2
    errors = capsys.readouterr().err
    assert "mine.yaml" in errors
    assert "Traceback" not in errors
    assert [path.name for path in tmp_path.iterdir()] == ["mine.yaml"]


@FEW
@given(data=st.data())
def test_damaged_results_are_a_message_and_never_a_traceback(results, tmp_path_factory, data):
    """Bytes changed anywhere in any file that a subcommand reads."""
    folder = tmp_path_factory.mktemp("damaged")
    for name in (
        "study.json",
        "tables/runs.parquet",
        "tables/verdicts.parquet",
        "tables/evidence.parquet",
        "tables/cells.parquet",
    ):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes((results.folder / name).read_bytes())
    path = folder / data.draw(
        st.sampled_from(["study.json", "tables/runs.parquet", "tables/verdicts.parquet"])
    )
    content = bytearray(path.read_bytes())
    for _ in range(data.draw(st.integers(1, 8))):
        content[data.draw(st.integers(0, len(content) - 1))] = data.draw(st.integers(0, 255))
    path.write_bytes(content[: data.draw(st.integers(0, len(content)))])
    for arguments in (
        ["doctor"],
        ["compare", str(results.folder)],
        ["report", "--templates", "report"],
    ):
        assert main([arguments[0], str(folder), *arguments[1:]]) in (0, 1, 2)
