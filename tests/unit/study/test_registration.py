"""What was written down before the runs that it judges."""

from pathlib import Path

import pytest

from upswing.study import registration
from upswing.study.claims import load_claims
from upswing.study.config import load
from upswing.study.errors import BadInput
from upswing.study.matrix import Matrix
from upswing.study.sweeps import load_sweeps

STUDY = load(Path("config/config.yaml"))
CLAIMS = load_claims(Path("config/claims.yaml"), STUDY)
SWEEPS = load_sweeps(Path("config/readings.yaml"), STUDY)
BEYOND = load(Path("config/beyond.yaml"))
EXPECTED = load_claims(Path("config/beyond-claims.yaml"), BEYOND)


def test_what_is_judged_is_what_was_registered_last():
    now = registration.of(STUDY, CLAIMS, SWEEPS, (BEYOND, EXPECTED))
    last = registration.load_registration(registration.REGISTRATION)[-1]
    changed = registration.changed_since(last, now)
    assert not changed, (
        f"{', '.join(changed)} changed: add an entry to {registration.REGISTRATION} that says why, and "
        f"which seeds are still unseen: {now.model_dump()}"
    )


def test_no_verdict_uses_a_seed_of_the_selection_or_one_that_was_seen_before():
    judged = {seed for spec in Matrix(STUDY).cells.values() for seed in spec.seeds}
    assert min(judged) >= 10_000
    for sweep in SWEEPS.values():
        assert judged.isdisjoint(range(sweep.first_seed, sweep.last_seed + 1))
    beyond = {seed for spec in Matrix(BEYOND).cells.values() for seed in spec.seeds}
    assert judged.isdisjoint(beyond)
    assert BEYOND.search is not None
    assert beyond.isdisjoint(BEYOND.search.seeds)


def test_a_threshold_a_seed_or_a_reading_that_changes_is_named():
    now = registration.of(STUDY, CLAIMS, SWEEPS, (BEYOND, EXPECTED))
    entry = registration.Entry(date="2026-11-26", registered=now, unseen="none", why="it is a test")
    part = CLAIMS["C2"].parts[0].model_copy(update={"at_least": 0.81})
    claims = {**CLAIMS, "C2": CLAIMS["C2"].model_copy(update={"parts": (part,)})}
    seeds = STUDY.model_copy(update={"seeds": (1,)})
    readings = STUDY.readings.model_copy(update={"ties": "first"})
    read = STUDY.model_copy(update={"readings": readings})
    without = {name: claim for name, claim in EXPECTED.items() if name != "B2"}
    for other, name in (
        ((STUDY, claims, SWEEPS), "claims"),
        ((seeds, CLAIMS, SWEEPS), "seeds"),
        ((read, CLAIMS, SWEEPS), "readings"),
        ((STUDY, CLAIMS, {"tables": SWEEPS["tables"]}), "sweeps"),
        ((STUDY, CLAIMS, SWEEPS, (BEYOND, without)), "beyond"),
        (
            (STUDY, CLAIMS, SWEEPS, (BEYOND.model_copy(update={"seeds": (6000,)}), EXPECTED)),
            "beyond",
        ),
    ):
        chapter = other[3] if len(other) > 3 else (BEYOND, EXPECTED)
        assert registration.changed_since(entry, registration.of(*other[:3], chapter)) == [name]
    assert registration.changed_since(entry, now) == []


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("entries: []", "entries"),
        ("entries: [{date: today, unseen: a, why: b}]", "entries[0].date"),
        ("entry: []", "entry"),
    ],
)
def test_a_bad_file_is_explained(tmp_path, text, expected):
    path = tmp_path / "registration.yaml"
    path.write_text(text, "utf-8")
    with pytest.raises(BadInput) as caught:
        registration.load_registration(path)
    assert expected in str(caught.value)
    assert "registration.yaml" in str(caught.value)
