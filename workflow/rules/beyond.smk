# Beyond the thesis: what is possible at all, what each change buys, what succeeds every time.


rule bound:
    input:
        no_file,
    output:
        f"{RESULTS}/{BOUND}",
        f"{RESULTS}/{MAPS}",
    log:
        f"{RESULTS}/logs/bound.log",
    benchmark:
        f"{RESULTS}/benchmarks/bound.tsv"
    resources:
        mem_mb=memory("bound"),
        runtime=minutes("bound"),
    params:
        **TOLD,
        pendulum=lambda wildcards: pendulum_of_bound(STUDY).model_dump_json(),
        code=jobs.bound().fingerprint,
    shell:
        "{params.upswing:q} bound {params.results:q} --study {params.asked:q} > {log:q} 2>&1"


rule settling:
    input:
        no_file,
    output:
        f"{RESULTS}/{SETTLING}",
    log:
        f"{RESULTS}/logs/settling.log",
    benchmark:
        f"{RESULTS}/benchmarks/settling.tsv"
    localrule: True
    resources:
        mem_mb=memory("settling"),
        runtime=minutes("settling"),
    params:
        **TOLD,
        pendulum=lambda wildcards: pendulum_of_bound(STUDY).model_dump_json(),
        code=jobs.SETTLING.fingerprint,
    shell:
        "{params.upswing:q} settling {params.results:q} --study {params.asked:q} > {log:q} 2>&1"


rule prediction:
    input:
        no_file,
    output:
        f"{RESULTS}/{PREDICTION}",
        f"{RESULTS}/{PREDICTION_LIMITS}",
    log:
        f"{RESULTS}/logs/prediction.log",
    benchmark:
        f"{RESULTS}/benchmarks/prediction.tsv"
    resources:
        mem_mb=memory("prediction"),
        runtime=minutes("prediction"),
    params:
        **TOLD,
        pendulum=lambda wildcards: pendulum_of_bound(STUDY).model_dump_json(),
        code=jobs.PREDICTION.fingerprint,
    shell:
        "{params.upswing:q} prediction {params.results:q} --study {params.asked:q} > {log:q} 2>&1"


rule changes:
    input:
        f"{RESULTS}/study.json",
        f"{RESULTS}/tables/runs.parquet",
        f"{RESULTS}/{BOUND}",
    output:
        f"{RESULTS}/{CHANGES}",
    log:
        f"{RESULTS}/logs/changes.log",
    benchmark:
        f"{RESULTS}/benchmarks/changes.tsv"
    localrule: True
    resources:
        mem_mb=memory("changes"),
        runtime=minutes("changes"),
    params:
        **TOLD,
        code=jobs.CHANGES.fingerprint,
    shell:
        "{params.upswing:q} changes {params.results:q} > {log:q} 2>&1"


rule shortest:
    # The study is given in the command and is no input: a new cell of it changes no search. What does stands
    # in the params. (An ancient input would do, but Snakemake looks at no params while it is to be made anew.)
    input:
        no_file,
    output:
        f"{RESULTS}/{SHORTEST}",
        f"{RESULTS}/{CHOSEN}",
    log:
        f"{RESULTS}/logs/shortest.log",
    benchmark:
        f"{RESULTS}/benchmarks/shortest.tsv"
    resources:
        mem_mb=lambda wildcards, attempt: attempt * needs_of_search(STUDY)[0],
        runtime=lambda wildcards, attempt: attempt * needs_of_search(STUDY)[1],
    params:
        **TOLD,
        search=lambda wildcards: SEARCH_TEXT,
        code=jobs.search(STUDY).fingerprint,
    shell:
        "{params.upswing:q} shortest {params.asked:q} --results {params.results:q} > {log:q} 2>&1"
