# Sweeps over readings: one job for a group of them.

SWEPT = {
    f"{name}/{group.name}": (sweep, group)
    for name, sweep in SWEEPS.items()
    for group in groups(sweep, STUDY)
}


rule sweep:
    input:
        # Its content counts, in the params; a new seed of the study changes no sweep.
        ancient(f"{RESULTS}/study.json"),
    output:
        f"{RESULTS}/readings/{{sweep}}/{{group}}.parquet",
    log:
        f"{RESULTS}/logs/sweep/{{sweep}}/{{group}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/sweep/{{sweep}}/{{group}}.tsv"
    params:
        content=lambda wildcards: content_of(
            SWEEPS[wildcards.sweep],
            STUDY,
            SWEPT[f"{wildcards.sweep}/{wildcards.group}"][1],
        ),
        code=lambda wildcards: sweep_code(SWEEPS[wildcards.sweep], STUDY),
    shell:
        "upswing sweep {wildcards.sweep} {wildcards.group} {RESULTS:q} > {log:q} 2>&1"
