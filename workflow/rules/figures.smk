# Figures, one job each.


rule figure:
    input:
        f"{RESULTS}/tables/runs.parquet",
        lambda wildcards: FILES.of_figure(wildcards.figure),
    output:
        report(
            f"{RESULTS}/figures/{{figure}}.svg",
            caption="../report/figure.rst",
            category="Figures",
            labels={"figure": "{figure}"},
        ),
        f"{RESULTS}/figures/{{figure}}.png",
        f"{RESULTS}/figures/{{figure}}.json",
    log:
        f"{RESULTS}/logs/figure/{{figure}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure/{{figure}}.tsv"
    params:
        code=lambda wildcards: jobs.figure(wildcards.figure).fingerprint,
    shell:
        "upswing figure {wildcards.figure:q} {RESULTS:q} > {log:q} 2>&1"
