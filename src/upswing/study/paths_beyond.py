"""Tables of the chapter beyond the thesis, apart from ``paths``: training reads that, not these."""

PREDICTION = "tables/prediction.parquet"
PREDICTION_LIMITS = "tables/prediction_limits.parquet"
