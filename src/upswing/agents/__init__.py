"""Who acts and learns: what a learner is told, what it holds, and how it learns from a step."""
