# Figures 5–11, one job each.


def figure_inputs(wildcards):
    cells = FIGURES[int(wildcards.number)].cells
    runs = [
        MATRIX.cells[cell].run(seed)
        for cell in cells
        for seed in MATRIX.cells[cell].seeds
    ]
    return expand(
        f"{RESULTS}/runs/{{run}}.{{kind}}",
        run=runs,
        kind=["trajectory.parquet", "windows.parquet"],
    )


rule figure:
    input:
        f"{RESULTS}/tables/runs.parquet",
        figure_inputs,
    output:
        f"{RESULTS}/figures/fig{{number}}.svg",
        f"{RESULTS}/figures/fig{{number}}.png",
        f"{RESULTS}/figures/fig{{number}}.json",
    log:
        f"{RESULTS}/logs/figure/{{number}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/figure/{{number}}.tsv"
    params:
        code=lambda wildcards: fingerprint(
            f"upswing.figures.fig{wildcards.number}", packages=["matplotlib"]
        ),
    shell:
        "upswing figure {wildcards.number} {RESULTS:q} > {log:q} 2>&1"
