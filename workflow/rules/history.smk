# What was found before: an entry for a study that came out otherwise than the last.


rule history:
    # Its output is the list of the entries, which stand beside it and never change: no output, for Snakemake
    # deletes those before a job. A note for the entry comes in the environment, so that it makes nothing run.
    input:
        f"{RESULTS}/study.json",
        FILES.tables,
    output:
        f"{RESULTS}/{ENTRIES}",
    log:
        f"{RESULTS}/logs/history.log",
    benchmark:
        f"{RESULTS}/benchmarks/history.tsv"
    priority: 2
    localrule: True
    resources:
        mem_mb=memory("history"),
        runtime=minutes("history"),
    params:
        **TOLD,
        code=jobs.HISTORY.fingerprint,
    shell:
        "{params.upswing:q} history write {params.results:q} > {log:q} 2>&1"
