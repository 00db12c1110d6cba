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
            MATRIX.cells,
        ),
        code=lambda wildcards: jobs.sweep(SWEEPS[wildcards.sweep], STUDY).fingerprint,
    shell:
        "upswing sweep {wildcards.sweep:q} {wildcards.group:q} {RESULTS:q} > {log:q} 2>&1"


rule readings:
    input:
        f"{RESULTS}/study.json",
        expand(f"{RESULTS}/readings/{{swept}}.parquet", swept=SWEPT),
    output:
        f"{RESULTS}/tables/selection.parquet",
        f"{RESULTS}/tables/readings.parquet",
        f"{RESULTS}/tables/decisive.parquet",
        f"{RESULTS}/tables/robust.parquet",
        expand(
            f"{RESULTS}/figures/readings-{{sweep}}.{{kind}}",
            sweep=[name for name in SWEEPS if name != "selection"],
            kind=["svg", "png"],
        ),
    log:
        f"{RESULTS}/logs/readings.log",
    benchmark:
        f"{RESULTS}/benchmarks/readings.tsv"
    params:
        claims=lambda wildcards: CLAIMS_TEXT,
        code=jobs.READINGS.fingerprint,
    shell:
        "upswing readings {RESULTS:q} > {log:q} 2>&1"
