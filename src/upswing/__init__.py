"""upswing: a reproduction of the bachelor's thesis *Reinforcement Learning in Motor Control*."""

__version__ = "0.1.0"
