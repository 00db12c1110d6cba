# From runs to tables.


# The longest way to the page leads over the study, the tables and the recordings that compare runs: they come
# first, and figures fill the other cores.


rule study:
    input:
        no_file,
    output:
        f"{RESULTS}/study.json",
    log:
        f"{RESULTS}/logs/study.log",
    benchmark:
        f"{RESULTS}/benchmarks/study.tsv"
    priority: 3
    params:
        study=lambda wildcards: STUDY_TEXT,
    shell:
        "upswing study {params.study:q} --results {RESULTS:q} > {log:q} 2>&1"


rule tables:
    input:
        f"{RESULTS}/study.json",
        FILES.of_cells(MATRIX.cells),
        lambda wildcards: FILES.adopted(),
    output:
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/tables/cells.parquet",
    log:
        f"{RESULTS}/logs/tables.log",
    benchmark:
        f"{RESULTS}/benchmarks/tables.tsv"
    priority: 2
    params:
        code=jobs.TABLES.fingerprint,
    shell:
        "upswing tables {RESULTS:q} > {log:q} 2>&1"


rule tiles:
    input:
        no_file,
    output:
        f"{RESULTS}/{TILES}",
    log:
        f"{RESULTS}/logs/tiles.log",
    benchmark:
        f"{RESULTS}/benchmarks/tiles.tsv"
    params:
        code=jobs.tiles().fingerprint,
    shell:
        "upswing tiles {RESULTS:q} > {log:q} 2>&1"


rule verdicts:
    input:
        FILES.of_cells(FILES.judged_cells),
        FILES.tiles,
        lambda wildcards: FILES.weighed(workflow.dag_settings.targets),
    output:
        f"{RESULTS}/tables/verdicts.parquet",
        f"{RESULTS}/tables/evidence.parquet",
    log:
        f"{RESULTS}/logs/verdicts.log",
    benchmark:
        f"{RESULTS}/benchmarks/verdicts.tsv"
    params:
        claims=lambda wildcards: CLAIMS_TEXT,
        readings=lambda wildcards: STUDY.readings.model_dump_json(),
        code=jobs.VERDICTS.fingerprint,
    shell:
        "upswing verdicts {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"
