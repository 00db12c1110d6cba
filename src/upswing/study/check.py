"""Everything that is written is checked before anything runs, and all problems are said at once."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, TypeVar

from upswing.study import places
from upswing.study.claims import Claim, file_of_claims, load_claims
from upswing.study.config import Study, from_snakemake, load, validated
from upswing.study.errors import BadInput
from upswing.study.own_files import CLAIMS, placed
from upswing.study.project_files import Files, along
from upswing.study.results_folder import check_results
from upswing.study.sweeps import Sweep, load_sweeps

T = TypeVar("T")


class Asked(NamedTuple):
    """What a run of the workflow is asked for."""

    study: Study
    claims: Mapping[str, Claim]
    sweeps: Mapping[str, Sweep]


def checked(
    config: Path, claims: Path | None, sweeps: Path, overlaid: Mapping[str, Any] | None = None
) -> Study:
    """The study in ``config``; claims and sweeps are looked at where their files are there.

    Args:
        config: the configuration.
        claims: the file of claims; without it, the study's own, or the thesis's.
        sweeps: the file of sweeps.
        overlaid: what Snakemake will be told beside the configuration, as ``--config``.

    Raises:
        BadInput: every problem of any of the files.
    """
    problems: list[str] = []
    source = "--config" if overlaid else str(config)
    study = _tried(
        problems, lambda: from_snakemake([config], overlaid) if overlaid else load(config)
    )
    if study is not None:
        _tried(problems, lambda: check_results(study.results, source))
    judged = (claims or along(places.CLAIMS)) if study is None else file_of_claims(study, claims)
    if judged.exists():
        _tried(problems, lambda: load_claims(judged, study))
    if sweeps.exists() and study is not None:
        _tried(problems, lambda: load_sweeps(sweeps, study))
    if problems or study is None:
        raise BadInput(problems)
    return study


def asked(
    files: Sequence[str | Path], merged: Mapping[str, Any], claims: Path, sweeps: Path
) -> Asked:
    """The same for a run of Snakemake: its configuration files, and what ``--config`` laid over them.

    ``claims`` are those of a study that names none of its own.

    Raises:
        BadInput: every problem of any of the files.
    """
    source = " + ".join(map(str, files))
    return _asked(lambda: from_snakemake(files, merged), source, claims, sweeps)


def asked_of_module(config: Mapping[str, Any], files: Files) -> Asked:
    """The same for a workflow that has the rules as a module, by the module's configuration.

    Raises:
        BadInput: every problem of any of the files.
    """
    source = "config of the module" if config else str(files.config)

    def read() -> Study:
        problems: list[str] = []
        own = {
            key: value for key, value in config.items() if key == CLAIMS
        }  # already a path from here
        content = placed(source, {**config, CLAIMS: None}, Path(), problems)
        del content[CLAIMS]
        return validated({source: {**content, **own}}, problems=problems)

    return _asked(
        read if config else lambda: load(files.config), source, files.claims, files.sweeps
    )


def _asked(read: Callable[[], Study], source: str, claims: Path, sweeps: Path) -> Asked:
    problems: list[str] = []
    study = _tried(problems, read)
    judged = claims if study is None else file_of_claims(study, otherwise=claims)
    claimed = _tried(problems, lambda: load_claims(judged, study))
    swept = None
    if study is not None:
        _tried(problems, lambda: check_results(study.results, source))
        swept = _tried(problems, lambda: load_sweeps(sweeps, study))
    if problems or study is None or claimed is None or swept is None:
        raise BadInput(problems)
    return Asked(study, claimed, swept)


def _tried(problems: list[str], read: Callable[[], T]) -> T | None:
    try:
        return read()
    except BadInput as error:
        problems += error.problems
        return None
