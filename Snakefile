# The study from configuration to report. Each rule calls one subcommand of `upswing`.


include: "workflow/rules/common.smk"


# The first rule is what is made where nothing is asked for; `-- all readings` judges every claim under other
# readings too, and the page then shows it.
rule all:
    input:
        FILES.everything,
        lambda wildcards: list(MATRIX.wanted(Path(RESULTS))),


include: "workflow/rules/train.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/readings.smk"
include: "workflow/rules/beyond.smk"
include: "workflow/rules/report.smk"
