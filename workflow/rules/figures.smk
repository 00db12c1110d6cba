# Figures, one job each.


def figure_inputs(wildcards):
    cells = FIGURES[wildcards.figure].cells or MATRIX.cells
    runs = [
        MATRIX.cells[cell].run(block.seeds[0])
        for cell in cells
        for block in MATRIX.blocks
    ]
    tables = [
        f"{RESULTS}/{table}"
        for table in FIGURES[wildcards.figure].tables
        if table not in (SHORTEST, CHOSEN) or STUDY.search
    ]
    kinds = FIGURES[wildcards.figure].files
    return tables + [
        f"{RESULTS}/{file_of(run, kind)}" for run in runs for kind in kinds
    ]


rule figure:
    input:
        f"{RESULTS}/tables/runs.parquet",
        figure_inputs,
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
