"""How what came out is shown: a table for a terminal or a pipe for each result."""
