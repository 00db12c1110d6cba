"""What is read besides results, from the folder of a study or of the project."""

from pathlib import Path

CONFIG = Path("config/config.yaml")
CLAIMS = Path("config/claims.yaml")
SWEEPS = Path("config/readings.yaml")
TEMPLATES = Path("report")
