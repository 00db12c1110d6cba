# Recordings that compare runs, and those that the page shows.
#
# They read files of all runs. The table of runs stands for them: it is made from a file of each run, and a
# job of training writes all files of a run together.


rule comparisons:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/verdicts.parquet",
    output:
        FILES.comparisons,
    log:
        f"{RESULTS}/logs/comparisons.log",
    benchmark:
        f"{RESULTS}/benchmarks/comparisons.tsv"
    params:
        code=jobs.COMPARISONS.fingerprint,
    shell:
        "upswing comparisons {RESULTS:q} > {log:q} 2>&1"


rule viewer:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/verdicts.parquet",
        FILES.pictures("json"),
        FILES.comparisons,
        "report/viewer.html",
    output:
        directory(f"{RESULTS}/report/viewer"),
    log:
        f"{RESULTS}/logs/viewer.log",
    benchmark:
        f"{RESULTS}/benchmarks/viewer.tsv"
    params:
        code=jobs.VIEWER.fingerprint,
    shell:
        "upswing viewer {RESULTS:q} > {log:q} 2>&1"
