"""How good anything can be on these tasks: dynamic programming with the pendulum's own step (§2.4.2).

The learners of the thesis know no model; here it is known, so that their results can be held
against the best there is.
"""
