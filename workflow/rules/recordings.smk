# Recordings that compare runs, one job each; that of a claim judges it, by its own cells and words. And the
# viewer of those that the page shows.


rule comparison:
    input:
        lambda wildcards: FILES.of_comparison(wildcards.comparison),
    output:
        f"{RESULTS}/recordings/{{comparison}}.rrd",
    log:
        f"{RESULTS}/logs/comparison/{{comparison}}.log",
    benchmark:
        f"{RESULTS}/benchmarks/comparison/{{comparison}}.tsv"
    priority: 1
    resources:
        mem_mb=memory("comparison"),
        runtime=minutes("comparison"),
    params:
        **TOLD,
        cells=lambda wildcards: FILES.cells_of_comparison(wildcards.comparison),
        seeds=lambda wildcards: FILES.seeds_of(
            FILES.cells_of_comparison(wildcards.comparison)
        ),
        words=lambda wildcards: FILES.words_of_comparison(wildcards.comparison),
        shown=lambda wildcards: FILES.shown(
            FILES.cells_of_comparison(wildcards.comparison)
        ),
        code=jobs.COMPARISON.fingerprint,
    shell:
        "{params.upswing:q} comparison {wildcards.comparison:q} {params.results:q} --study {params.asked:q} --claims {params.claims_file:q} > {log:q} 2>&1"


rule viewer:
    # It writes more than its page, which comes last. What is there and still right stays.
    input:
        FILES.pictures("json"),
        FILES.comparisons,
        f"{TEMPLATES}/viewer.html",
    output:
        f"{RESULTS}/{VIEWER_PAGE}",
    log:
        f"{RESULTS}/logs/viewer.log",
    benchmark:
        f"{RESULTS}/benchmarks/viewer.tsv"
    localrule: True
    resources:
        mem_mb=memory("viewer"),
        runtime=minutes("viewer"),
    params:
        **TOLD,
        code=jobs.VIEWER.fingerprint,
    shell:
        "{params.upswing:q} viewer {params.results:q} --study {params.asked:q} --claims {params.claims_file:q} --templates {params.templates:q} > {log:q} 2>&1"
