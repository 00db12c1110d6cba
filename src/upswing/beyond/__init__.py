"""Beyond the thesis: what each change to it buys, and what learns full control every time."""
