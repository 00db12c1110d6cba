# Sweeps over readings: one job for a group of them.


rule sweep:
    # The study is given in the command and is no input (as in beyond.smk): a new seed or cell changes no sweep.
    input:
        no_file,
    output:
        f"{RESULTS}/readings/{{sweep}}/{{group}}.parquet",
    log:
        f"{RESULTS}/logs/sweep/{{sweep}}/{{group}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/{{sweep}}/{{group}}.tsv"
    params:
        content=lambda wildcards: FILES.content_of_sweep(
            f"{wildcards.sweep}/{wildcards.group}"
        ),
        code=lambda wildcards: jobs.sweep(SWEEPS[wildcards.sweep], STUDY).fingerprint,
    shell:
        "upswing sweep {wildcards.sweep:q} {wildcards.group:q} {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"


rule readings:
    input:
        f"{RESULTS}/study.json",
        FILES.swept,
    output:
        FILES.readings,
    log:
        f"{RESULTS}/logs/readings.log",
    benchmark:
        f"{RESULTS}/benchmarks/readings.tsv"
    params:
        claims=lambda wildcards: CLAIMS_TEXT,
        code=jobs.READINGS.fingerprint,
    shell:
        "upswing readings {RESULTS:q} > {log:q} 2>&1"
