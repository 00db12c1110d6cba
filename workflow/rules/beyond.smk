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
    params:
        pendulum=lambda wildcards: pendulum_of_bound(STUDY).model_dump_json(),
        code=jobs.bound().fingerprint,
    shell:
        "upswing bound {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"


rule settling:
    input:
        no_file,
    output:
        f"{RESULTS}/{SETTLING}",
    log:
        f"{RESULTS}/logs/settling.log",
    benchmark:
        f"{RESULTS}/benchmarks/settling.tsv"
    params:
        pendulum=lambda wildcards: pendulum_of_bound(STUDY).model_dump_json(),
        code=jobs.SETTLING.fingerprint,
    shell:
        "upswing settling {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"


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
    params:
        code=jobs.CHANGES.fingerprint,
    shell:
        "upswing changes {RESULTS:q} > {log:q} 2>&1"


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
    params:
        search=lambda wildcards: SEARCH_TEXT,
        code=jobs.search(STUDY).fingerprint,
    shell:
        "upswing shortest {STUDY_TEXT:q} --results {RESULTS:q} > {log:q} 2>&1"
