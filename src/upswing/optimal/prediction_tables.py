"""What is in the tables of prediction."""

OF_PREDICTION = {
    "discount": "number", "tiles": "whole", "method": "text", "step_size": "number",
    "halved_after": "number", "seeds": "text", "runs": "whole", "steps": "whole",
    "error": "number", "low": "number", "high": "number",
}  # fmt: skip
OF_LIMITS = {"discount": "number", "tiles": "whole", "quantity": "text", "value": "number"}

SIZE, SPREAD = "V", "spread of V inside a tile"
VARYING = "spread of the returns of a state"
HALF_AS_FINE = "V on a grid half as fine"
"""Quantities of the table of limits, beside the limit of each method."""

BAND = (0.1, 0.9)
"""The quantiles over seeds that are in the table."""

REMEDY = "`upswing prediction` makes it"
