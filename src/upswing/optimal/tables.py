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
SETTLING_REMEDY = "`upswing settling` makes it"
REMEDY = "`upswing bound` makes it"
