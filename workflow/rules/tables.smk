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
    localrule: True
    resources:
        mem_mb=memory("study"),
        runtime=minutes("study"),
    params:
        **TOLD,
        study=lambda wildcards: STUDY_TEXT,
    shell:
        "{params.upswing:q} study {params.study:q} --results {params.results:q} > {log:q} 2>&1"


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
    localrule: True
    resources:
        mem_mb=memory("tables"),
        runtime=minutes("tables"),
    params:
        **TOLD,
        code=jobs.TABLES.fingerprint,
    shell:
        "{params.upswing:q} tables {params.results:q} > {log:q} 2>&1"


rule tiles:
    input:
        no_file,
    output:
        f"{RESULTS}/{TILES}",
    log:
        f"{RESULTS}/logs/tiles.log",
    benchmark:
        f"{RESULTS}/benchmarks/tiles.tsv"
    localrule: True
    resources:
        mem_mb=memory("tiles"),
        runtime=minutes("tiles"),
    params:
        **TOLD,
        code=jobs.tiles().fingerprint,
    shell:
        "{params.upswing:q} tiles {params.results:q} > {log:q} 2>&1"


rule verdicts:
    input:
        FILES.of_cells(FILES.judged_cells),
        FILES.tiles,
        lambda wildcards: FILES.weighed(targets()),
    output:
        f"{RESULTS}/tables/verdicts.parquet",
        f"{RESULTS}/tables/evidence.parquet",
    log:
        f"{RESULTS}/logs/verdicts.log",
    benchmark:
        f"{RESULTS}/benchmarks/verdicts.tsv"
    localrule: True
    resources:
        mem_mb=memory("verdicts"),
        runtime=minutes("verdicts"),
    params:
        **TOLD,
        seeds=lambda wildcards: FILES.seeds_of(FILES.judged_cells),
        claims=lambda wildcards: CLAIMS_TEXT,
        readings=lambda wildcards: STUDY.readings.model_dump_json(),
        code=jobs.VERDICTS.fingerprint,
    shell:
        "{params.upswing:q} verdicts {params.results:q} --study {params.asked:q} --claims {params.claims_file:q} --templates {params.templates:q} > {log:q} 2>&1"
