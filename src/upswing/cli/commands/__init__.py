"""The subcommands: a module for each group, by how they are used. Each calls one typed function."""
