"""Would another reading have changed the verdict? Sweeps over readings, judged."""
