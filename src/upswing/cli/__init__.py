"""The command line: a thin subcommand for each job."""
