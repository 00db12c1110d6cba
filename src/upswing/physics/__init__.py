"""What moves: the pendulum on its cart, its tasks, and one step of them, whoever acts."""
