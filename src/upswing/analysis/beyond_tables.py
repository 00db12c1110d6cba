"""What is in the tables of what goes beyond the thesis; the page needs no more."""

OF_A_CHANGE = {
    "change": "text", "cell": "text", "task": "text", "kind": "text", "steps": "whole",
    "architecture": "text", "alpha": "number", "discount": "number", "epsilon": "number",
    "runs": "whole", "successes": "whole", "success": "number", "success_low": "number",
    "success_high": "number", "sure": "whole", "stable": "whole", "stable_step": "number",
    "stable_low": "number", "stable_high": "number", "nanoseconds": "number", "upright": "number",
    "missing": "number", "missing_low": "number", "missing_high": "number", "cost": "number",
    "median_run": "text",
}  # fmt: skip
OF_A_CANDIDATE = {
    "group": "whole", "title": "text", "architecture": "text", "alpha": "number", "discount": "number",
    "steps": "whole", "seeds": "whole", "sure": "whole", "worst": "number",
}  # fmt: skip
OF_THE_CHOSEN = {
    "title": "text", "architecture": "text", "alpha": "number", "discount": "number",
    "seeds": "whole", "steps": "number", "sure": "whole",
}  # fmt: skip
REMEDY = "`make beyond` makes it"

"""The chapter's own results lie in this folder of the study's."""
