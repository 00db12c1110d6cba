# Recordings that compare runs.


rule comparisons:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/verdicts.parquet",
        expand(
            f"{RESULTS}/runs/{{run}}.{{kind}}",
            run=MATRIX.runs,
            kind=["trajectory.parquet", "windows.parquet"],
        ),
    output:
        expand(
            f"{RESULTS}/recordings/{{name}}.rrd",
            name=comparison_names(CLAIMS, MATRIX.cells),
        ),
    log:
        f"{RESULTS}/logs/comparisons.log",
    benchmark:
        f"{RESULTS}/benchmarks/comparisons.tsv"
    params:
        code=fingerprint("upswing.recordings.comparison", packages=["rerun-sdk"]),
    shell:
        "upswing comparisons {RESULTS:q} > {log:q} 2>&1"
