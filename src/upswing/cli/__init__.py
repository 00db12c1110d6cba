"""The command line: a thin subcommand for each job, in groups by how they are used."""
