# The page.


rule report:
    input:
        lambda wildcards: FILES.of_page(targets()),
        lambda wildcards: templates(READ.templates),
    output:
        report(
            f"{RESULTS}/report/index.html",
            caption="../report/page.rst",
            category="The page",
            labels={"what": "every claim and its verdict"},
        ),
        f"{RESULTS}/report/runs.csv",
        f"{RESULTS}/report/evidence.csv",
    log:
        f"{RESULTS}/logs/report.log",
    benchmark:
        f"{RESULTS}/benchmarks/report.tsv"
    localrule: True
    resources:
        mem_mb=memory("report"),
        runtime=minutes("report"),
    params:
        **TOLD,
        code=jobs.page(FILES.project_figures).fingerprint,
        swept=lambda wildcards: FILES.shown_as_of(targets()),
    shell:
        "{params.upswing:q} report {params.results:q} --templates {params.templates:q} > {log:q} 2>&1"
