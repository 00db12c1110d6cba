"""What a run leaves on disk: Parquet tables, weights, a recording, each with its provenance."""
