"""What the runs say: estimates, verdicts, comparisons, and whether the results are whole."""
