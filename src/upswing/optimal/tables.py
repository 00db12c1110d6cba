"""What is in the tables of the bound."""

FULL_CONTROL = "full-control"
"""The task that rows are of, where no other is said."""

OF_THE_BOUND = {
    "quantity": "text", "value": "number", "unit": "text", "grid": "text", "task": "text",
    "policy": "text?", "discount": "number", "note": "text",
}  # fmt: skip
OF_THE_MAPS = {
    "angle": "number", "angular_velocity": "number", "time_to_upright": "number", "keepable": "truth",
}  # fmt: skip
OF_SETTLING = {
    "method": "text", "discount": "number", "backups": "whole", "improvements": "whole",
    "error": "number", "worse": "number",
}  # fmt: skip
OF_PREDICTION = {
    "discount": "number", "tiles": "whole", "method": "text", "step_size": "number",
    "halved_after": "number", "seeds": "text", "runs": "whole", "steps": "whole",
    "error": "number", "low": "number", "high": "number",
}  # fmt: skip
OF_PREDICTION_LIMITS = {
    "discount": "number", "tiles": "whole", "quantity": "text", "value": "number",
}  # fmt: skip
SIZE, SPREAD = "V", "spread of V inside a tile"
VARYING = "spread of the returns of a state"
HALF_AS_FINE = "V on a grid half as fine"
"""Quantities of the limits of prediction, beside the methods."""

BAND = (0.1, 0.9)
"""The quantiles over seeds in the table of prediction."""

PREDICTION_REMEDY = "`upswing prediction` makes it"
SETTLING_REMEDY = "`upswing settling` makes it"
REMEDY = "`upswing bound` makes it"
