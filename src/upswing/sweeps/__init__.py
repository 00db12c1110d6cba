"""Would another reading have changed the verdict? Grids of readings, of which only measures are kept."""
