"""What is asked: configuration, cells and runs, claims, and the code that each job runs."""
