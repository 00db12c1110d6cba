# Sweeps over readings: one job for a group of them.


rule sweep:
    # The study is given in the command and is no input (as in beyond.smk): a new seed or cell changes no sweep.
    # A job of a later round reads which readings go on.
    input:
        lambda wildcards: no_file(wildcards)
        + FILES.before_sweep(f"{wildcards.sweep}/{wildcards.group}"),
    output:
        f"{RESULTS}/readings/{{sweep}}/{{group}}.parquet",
    log:
        f"{RESULTS}/logs/sweep/{{sweep}}/{{group}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/{{sweep}}/{{group}}.tsv"
    resources:
        mem_mb=memory("sweep"),
        runtime=minutes("sweep"),
    params:
        **TOLD,
        content=lambda wildcards: FILES.content_of_sweep(
            f"{wildcards.sweep}/{wildcards.group}"
        ),
        code=lambda wildcards: jobs.sweep(SWEEPS[wildcards.sweep], STUDY).fingerprint,
    shell:
        "{params.upswing:q} sweep {wildcards.sweep:q} {wildcards.group:q} {params.results:q} --study {params.asked:q} --sweeps {params.sweeps_file:q} > {log:q} 2>&1"


rule finalists:
    # Which readings go on to a round of a sweep.
    input:
        lambda wildcards: FILES.before_round(wildcards.sweep, int(wildcards.number)),
    output:
        f"{RESULTS}/readings/{{sweep}}/round-{{number}}.json",
    log:
        f"{RESULTS}/logs/finalists/{{sweep}}/round-{{number}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/finalists/{{sweep}}/round-{{number}}.tsv"
    localrule: True
    resources:
        mem_mb=memory("finalists"),
        runtime=minutes("finalists"),
    params:
        **TOLD,
        reports=lambda wildcards: FILES.reports_of_sweep(wildcards.sweep),
        code=jobs.FINALISTS.fingerprint,
    shell:
        "{params.upswing:q} finalists {wildcards.sweep:q} {wildcards.number:q} {params.results:q} --study {params.asked:q} --sweeps {params.sweeps_file:q} > {log:q} 2>&1"


rule readings:
    # As above, the study is no input: judging all sweeps takes a while, and no new cell of the study changes it.
    # Nor does `make reproduce`: without being asked for them it takes these files as they are, and so the sweeps.
    # A job of its own process (on a cluster) was asked for by the process that planned it.
    input:
        FILES.tiles,
        lambda wildcards: (
            FILES.judged_from(targets())
            if workflow.is_main_process
            else FILES.swept
        ),
    output:
        FILES.readings,
    log:
        f"{RESULTS}/logs/readings.log",
    benchmark:
        f"{RESULTS}/benchmarks/readings.tsv"
    resources:
        mem_mb=memory("readings"),
        runtime=minutes("readings"),
    params:
        **TOLD,
        claims=lambda wildcards: CLAIMS_TEXT,
        swept=lambda wildcards: FILES.content_of_readings,
        code=jobs.READINGS.fingerprint,
    shell:
        "{params.upswing:q} readings {params.results:q} --study {params.asked:q} --sweeps {params.sweeps_file:q} --claims {params.claims_file:q} > {log:q} 2>&1"
