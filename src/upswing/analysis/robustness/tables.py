"""What is in the tables of the sweeps; light: the page depends on nothing more."""

OF_A_SELECTION = {
    "reward_unit": "text", "biases": "text", "initial_weights": "number", "learning_rate": "number",
    "runs": "whole", "p7": "number", "p9": "number", "p11": "number", "likelihood": "number",
    **{f"p{figure}_successes": "whole" for figure in (7, 9, 11)},
}  # fmt: skip
OF_A_READING = {
    "sweep": "text", "readings": "text", "label": "text", "claim": "text", "estimate": "number",
    "n": "whole", "verdict": "text", "holds": "truth", "estimate_holds": "truth", "is_default": "truth",
}  # fmt: skip
OF_A_CAUSE = {
    "claim": "text", "sweep": "text", "readings": "text", "names": "text", "effect": "number",
    "under": "text",
}  # fmt: skip
OF_A_SUMMARY = {
    "claim": "text", "sweep": "text", "readings": "whole", "holds": "whole", "estimate_holds": "whole",
    "default": "text", "reproduced": "whole", "partly": "whole", "inconclusive": "whole",
    "not reproduced": "whole",
}  # fmt: skip
REMEDY = "`make readings` makes it"
