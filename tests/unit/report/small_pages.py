"""The page of a small study, made without the workflow."""

from pathlib import Path

from upswing.analysis.aggregate import write_tables
from upswing.analysis.verdicts import write_verdicts
from upswing.figures import draw, drawable
from upswing.optimal.represented import write_represented
from upswing.report.page import page_of
from upswing.report.targets import Targets
from upswing.runs.results import Results
from upswing.runs.study_file import canonical, write_study
from upswing.runs.train import train
from upswing.study.claims import load_claims
from upswing.study.config import validated
from upswing.study.matrix import Matrix


def page_of_small(content, folder: Path) -> str:
    """Run a study, judge it, draw its figures, and return its page."""
    study, claims = validated({"study": content}), load_claims(Path("config/claims.yaml"))
    matrix = Matrix(study)
    write_study(canonical(study), folder)
    for spec in matrix.cells.values():
        train(spec, folder)
    write_tables(folder, matrix)
    results = Results(folder)
    if Targets(study, claims, {}).tiles:  # a claim asks what a table can represent
        write_represented(folder)
    write_verdicts(results, claims, {})
    for name in drawable(matrix.cells, asked=study.figures):
        draw(name, results, claims)
    return page_of(folder, Path("report")).html
