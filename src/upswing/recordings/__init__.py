"""Rerun recordings for people to browse: one of every run, and comparisons between runs.

Parquet is the archive; a recording can be made again from what it was made of.
"""
