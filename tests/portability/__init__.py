"""Where it runs: the lock files for all platforms, and the table of the documentation that says which."""
