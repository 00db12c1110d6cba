# Training: one job for every cell and block of seeds, one rule for every block.

for BLOCK in MATRIX.blocks:

    rule:
        name:
            f"train_{BLOCK.name}"
        input:
            no_file,
        output:
            expand(
                f"{RESULTS}/runs/{{{{task}}}}/{{{{architecture}}}}/alpha-{{{{alpha}}}}/seed-{{seed}}.{KNOWN_FILE}",
                seed=BLOCK.seeds,
            ),
        log:
            f"{RESULTS}/logs/train/{{task}}/{{architecture}}/alpha-{{alpha}}/{BLOCK.name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/train/{{task}}/{{architecture}}/alpha-{{alpha}}/{BLOCK.name}.tsv"
        params:
            spec=lambda wildcards, block=BLOCK: MATRIX.job(
                f"{wildcards.task}/{wildcards.architecture}/alpha-{wildcards.alpha}",
                block,
            ).canonical(),
            code=lambda wildcards: jobs.training(
                STUDY.architectures[wildcards.architecture],
                STUDY.tasks[wildcards.task].kind,
            ).fingerprint,
        shell:
            "upswing train {params.spec:q} --results {RESULTS:q} > {log:q} 2>&1"
