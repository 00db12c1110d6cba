"""Where the tables of the sweeps stand; light, so that the page need not depend on how they are made."""

SELECTION = "tables/selection.parquet"
READINGS = "tables/readings.parquet"
DECISIVE = "tables/decisive.parquet"
ROBUST = "tables/robust.parquet"
