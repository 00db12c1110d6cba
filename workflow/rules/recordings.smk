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
    params:
        cells=lambda wildcards: FILES.cells_of_comparison(wildcards.comparison),
        words=lambda wildcards: FILES.words_of_comparison(wildcards.comparison),
        shown=lambda wildcards: FILES.shown(
            FILES.cells_of_comparison(wildcards.comparison)
        ),
        code=jobs.COMPARISON.fingerprint,
    shell:
        "upswing comparison {wildcards.comparison:q} {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"


rule viewer:
    # It writes more than its page, which comes last. What is there and still right stays.
    input:
        FILES.pictures("json"),
        FILES.comparisons,
        "report/viewer.html",
    output:
        f"{RESULTS}/{VIEWER_PAGE}",
    log:
        f"{RESULTS}/logs/viewer.log",
    benchmark:
        f"{RESULTS}/benchmarks/viewer.tsv"
    params:
        code=jobs.VIEWER.fingerprint,
    shell:
        "upswing viewer {RESULTS:q} --study {STUDY_TEXT:q} > {log:q} 2>&1"
