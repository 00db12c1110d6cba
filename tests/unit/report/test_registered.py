"""What the page says of the registration: every entry, and what of a study is not as the last one says."""

from upswing.report import registered as module
from upswing.report.registered import registered
from upswing.study.claims import canonical_claims, load_claims
from upswing.study.registration import checksum_of, load_registration, seeds_of

ENTRY = """
  - date: "2026-11-26"
    registered: {{claims: "{claims}", sweeps: "{zero}", seeds: "{seeds}", readings: "{readings}"}}
    unseen: seeds from {number} on
    why: version {number}
"""
ZERO = "0" * 16


def written(path, *entries):
    rows = [
        ENTRY.format(
            **{"claims": ZERO, "seeds": ZERO, "readings": ZERO, **one}, zero=ZERO, number=n
        )
        for n, one in enumerate(entries)
    ]
    path.write_text("entries:" + "".join(rows), "utf-8")


def test_what_is_not_as_it_was_registered_is_named(results, tmp_path, monkeypatch):
    path = tmp_path / "registration.yaml"
    monkeypatch.setattr(module, "REGISTRATION", path)
    assert registered(results.folder, results.study) is None
    seeds = seeds_of(results.study)
    readings = checksum_of(results.study.readings.model_dump_json())
    written(path, {}, {"seeds": seeds, "readings": readings})
    found = registered(results.folder, results.study)
    assert found["changed"] == ["claims"]
    assert [one["why"] for one in found["entries"]] == ["version 0", "version 1"]
    written(path, {"seeds": seeds, "readings": readings}, {})
    assert registered(results.folder, results.study)["changed"] == ["seeds", "readings", "claims"]


def test_the_project_s_own_claims_are_those_that_the_results_are_judged_by(results):
    last = load_registration(module.REGISTRATION)[-1]
    claims = canonical_claims(load_claims(module.REGISTRATION.with_name("claims.yaml")))
    assert last.registered.claims == checksum_of(claims)
    assert "claims" not in registered(results.folder, results.study)["changed"]
