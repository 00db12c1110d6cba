"""Where the tables of this room stand; light, so that the page need not depend on how they are made."""

CHANGES = "tables/changes.parquet"
SHORTEST = "tables/shortest.parquet"
CHOSEN = "tables/chosen.parquet"

FOLDER = "beyond"
"""The chapter's own results lie in this folder of the study's."""
