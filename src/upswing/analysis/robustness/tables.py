"""What is in the tables of the sweeps; light: the page depends on nothing more."""

OF_A_SELECTION = {
    "reward_unit": "text", "biases": "text", "initial_weights": "number", "learning_rate": "number",
    "runs": "whole", "p7": "number", "p9": "number", "p11": "number", "likelihood": "number",
    "low": "number", "high": "number", "best": "number",
    **{
        f"p{figure}_{what}": "whole"
        for figure in (7, 9, 11)
        for what in ("successes", "failures", "diverged")
    },
}  # fmt: skip
OF_A_READING = {
    "sweep": "text", "readings": "text", "label": "text", "claim": "text", "estimate": "number",
    "n": "whole", "verdict": "text", "holds": "truth", "estimate_holds": "truth",
    "probability": "number", "is_default": "truth",
}  # fmt: skip
OF_A_CAUSE = {
    "claim": "text", "sweep": "text", "readings": "text", "names": "text", "effect": "number",
    "under": "text",
}  # fmt: skip
OF_A_SUMMARY = {
    "claim": "text", "sweep": "text", "readings": "whole", "holds": "whole", "estimate_holds": "whole",
    "default": "text", "reproduced": "whole", "partly": "whole", "inconclusive": "whole",
    "not reproduced": "whole", "held_share": "number", "weighted_share": "number",
    "weighted_low": "number", "weighted_high": "number", "grade": "text", "left_out": "text",
    "by_prior": "text",
}  # fmt: skip
SHIPPED = "readings.json"
"""Among the templates of the page: how claims do over readings, for a study that has not swept them."""

LEDGER_OF_READINGS = "readings"
"""The ledger of these tables; it has checksums of the code and the claims by which they were made."""

REMEDY = "`make readings` makes it"
