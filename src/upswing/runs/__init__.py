"""One run, its files, and reading them back."""
