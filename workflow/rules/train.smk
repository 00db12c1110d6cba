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
        params:
            spec=lambda wildcards, block=BLOCK: MATRIX.job(
                wildcards.cell, block
            ).canonical(),
            code=lambda wildcards: jobs.training(
                MATRIX.cells[wildcards.cell].architecture,
                MATRIX.cells[wildcards.cell].task.kind,
            ).fingerprint,
        shell:
            "upswing train {params.spec:q} --results {RESULTS:q} > {log:q} 2>&1"
