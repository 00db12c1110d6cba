"""Where the tables of the bound stand; light, so that the workflow can read it."""

BOUND = "tables/bound.parquet"
MAPS = "tables/bound_maps.parquet"
