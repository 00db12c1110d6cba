# The page.


rule report:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/cells.parquet",
        f"{RESULTS}/tables/verdicts.parquet",
        f"{RESULTS}/tables/evidence.parquet",
        expand(
            f"{RESULTS}/figures/fig{{number:02d}}.{{kind}}",
            number=DRAWABLE,
            kind=["svg", "json"],
        ),
        "report/index.html.j2",
        "report/style.css",
    output:
        f"{RESULTS}/report/index.html",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    params:
        code=fingerprint("upswing.report"),
    shell:
        "upswing report {RESULTS:q} > {log:q} 2>&1"
