# The study from configuration to report. Each rule calls one subcommand of `upswing`.


include: "workflow/rules/common.smk"


# What is made where nothing is asked for.
rule all:
    input:
        FILES.everything,
        lambda wildcards: list(MATRIX.wanted(Path(RESULTS))),


# The same, with every claim judged under other readings too, which the page then shows.
rule with_readings:
    input:
        rules.all.input,
        FILES.swept,
        FILES.readings,


include: "workflow/rules/train.smk"
include: "workflow/rules/tables.smk"
include: "workflow/rules/figures.smk"
include: "workflow/rules/recordings.smk"
include: "workflow/rules/readings.smk"
include: "workflow/rules/beyond.smk"
include: "workflow/rules/history.smk"
include: "workflow/rules/report.smk"
