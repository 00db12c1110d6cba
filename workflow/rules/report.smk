# The page.


rule report:
    input:
        lambda wildcards: FILES.of_page(workflow.dag_settings.targets),
        lambda wildcards: templates(Path("report")),
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
    params:
        code=jobs.page(FILES.project_figures).fingerprint,
    shell:
        "upswing report {RESULTS:q} > {log:q} 2>&1"
