"""How fast a step is, against programs one would write without thinking of speed, or with it."""
