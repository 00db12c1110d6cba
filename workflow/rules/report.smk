# The page.

TEMPLATES = sorted(
    str(path)
    for pattern in ("*.j2", "*.css", "*.js", "*.yaml", "parts/*", "drawings/*")
    for path in Path("report").glob(pattern)
)
SWEPT_TABLES = [
    f"{RESULTS}/tables/{name}.parquet"
    for name in ("selection", "readings", "decisive", "robust")
]


CHAPTER = sorted(
    str(path)
    for folder in (Path(RESULTS), Path(RESULTS, FOLDER))
    for name in (CHANGED, BOUND, CHOSEN, "figures/bound.svg", "figures/changes.svg")
    for path in [folder / name]
)


rule report:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/cells.parquet",
        f"{RESULTS}/tables/verdicts.parquet",
        f"{RESULTS}/tables/evidence.parquet",
        expand(
            f"{RESULTS}/figures/{{figure}}.{{kind}}",
            figure=DRAWABLE,
            kind=["svg", "json"],
        ),
        TEMPLATES,
        # Where the sweeps over readings have been run, the page shows them.
        [path for path in SWEPT_TABLES if Path(path).exists()],
        # Its own chapter beyond the thesis, or that of the folder below, where that has been run.
        BEYOND_TABLES if CHANGES else [path for path in CHAPTER if Path(path).exists()],
    output:
        report(
            f"{RESULTS}/report/index.html",
            caption="../report/page.rst",
            category="The page",
            labels={"what": "every claim and its verdict"},
        ),
        f"{RESULTS}/report/runs.csv",
        f"{RESULTS}/report/evidence.csv",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    params:
        code=jobs.page(FIGURES).fingerprint,
    shell:
        "upswing report {RESULTS:q} > {log:q} 2>&1"
