# Figures, one job each.


rule figure:
    # The study is given in the command and is no input: a figure depends on its own cells and claims, and no other
    # of the study draws it anew.
    input:
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
    resources:
        mem_mb=memory("figure"),
        runtime=minutes("figure"),
    params:
        **TOLD,
        cells=lambda wildcards: FILES.cells_of_figure(wildcards.figure),
        seeds=lambda wildcards: FILES.seeds_of(FILES.cells_of_figure(wildcards.figure)),
        words=lambda wildcards: FILES.words_of_figure(wildcards.figure),
        shown=lambda wildcards: FILES.shown(FILES.cells_of_figure(wildcards.figure)),
        code=lambda wildcards: FILES.code_of_figure(wildcards.figure),
    shell:
        "{params.upswing:q} figure {wildcards.figure:q} {params.results:q} --study {params.asked:q} --claims {params.claims_file:q} > {log:q} 2>&1"
