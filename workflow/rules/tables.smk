# From runs to tables.


rule study:
    output:
        f"{RESULTS}/study.json",
    log:
        f"{RESULTS}/logs/study.log",
    benchmark:
        f"{RESULTS}/benchmarks/study.tsv"
    params:
        study=canonical(STUDY),
    shell:
        "upswing study {params.study:q} --results {RESULTS:q} > {log:q} 2>&1"


rule tables:
    input:
        f"{RESULTS}/study.json",
        expand(f"{RESULTS}/runs/{{run}}.windows.parquet", run=MATRIX.runs),
    output:
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/cells.parquet",
    log:
        f"{RESULTS}/logs/tables.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables.tsv"
    params:
        code=fingerprint("upswing.tables"),
    shell:
        "upswing tables {RESULTS:q} > {log:q} 2>&1"
