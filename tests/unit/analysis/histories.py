"""What tests of the history share: the results of a small study, judged by other thresholds."""

from pathlib import Path

from upswing.analysis.doctor import examine
from upswing.analysis.history.read import damaged, entries
from upswing.analysis.verdicts import write_verdicts
from upswing.runs.files.ledger import ledger_path, read_ledger
from upswing.runs.results import Results
from upswing.study.claims import load_claims
from upswing.study.history_paths import HISTORY, folder_of, ledger_of

CLAIMS = load_claims(Path("config/claims.yaml"))
ADDED = ("report", "figures", "recordings", "report.json", "viewer.json", "comparisons.json")
"""What other tests may have added to the results."""


def stricter(of="C16", at_least=0.999):
    """The claims with another threshold."""
    claim = CLAIMS[of]
    part = claim.parts[0].model_copy(update={"at_least": at_least})
    return {**CLAIMS, of: claim.model_copy(update={"parts": (part, *claim.parts[1:])})}


def judge(folder, claims=CLAIMS):
    write_verdicts(Results(folder), claims, {})


def findings(folder):
    """What is wrong with the history of a folder."""
    return [f for f in examine(folder).findings if HISTORY in str(f.path.relative_to(folder))]


def whole(folder):
    """Every entry has all files that its ledger names, and every folder of the history is an entry's."""
    there = [path for path in (folder / HISTORY).iterdir() if not path.name.startswith(".")]
    names = {path.name for path in there if path.is_dir()}
    assert names == {entry.id for entry in entries(folder)}
    assert damaged(folder) == []
    for entry in entries(folder):
        ledger = read_ledger(ledger_path(folder, ledger_of(entry.id)))
        files = {str(path.relative_to(folder)) for path in (folder / folder_of(entry.id)).iterdir()}
        assert files == set(ledger.files)
