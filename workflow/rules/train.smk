# Training: one job for every cell and block of seeds, one rule for every block.

for BLOCK, CELLS_OF_BLOCK in MATRIX.blocks.items():

    rule:
        name:
            f"train_{BLOCK.name}"
        input:
            no_file,
        output:
            expand(
                f"{RESULTS}/runs/{{{{cell}}}}/seed-{{seed}}.{KNOWN_FILE}",
                seed=BLOCK.seeds,
            ),
        log:
            f"{RESULTS}/logs/train/{{cell}}/{BLOCK.name}.log",
        benchmark:
            f"{RESULTS}/benchmarks/train/{{cell}}/{BLOCK.name}.tsv"
        wildcard_constraints:
            cell="|".join(map(re.escape, CELLS_OF_BLOCK)),
        resources:
            mem_mb=lambda wildcards, attempt: attempt
            * memory_of_training(MATRIX.cells[wildcards.cell].task.steps),
            runtime=lambda wildcards, attempt, block=BLOCK: attempt
            * minutes_of_training(MATRIX.job(wildcards.cell, block)),
        params:
            **TOLD,
            spec=lambda wildcards, block=BLOCK: MATRIX.job(
                wildcards.cell, block
            ).canonical(),
            code=lambda wildcards: jobs.training(
                MATRIX.cells[wildcards.cell].architecture,
                MATRIX.cells[wildcards.cell].task.kind,
            ).fingerprint,
        shell:
            "{params.upswing:q} train {params.spec:q} --results {params.results:q} > {log:q} 2>&1"
