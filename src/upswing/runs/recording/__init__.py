"""The Rerun recording of a run: its rows, its pictures, its layout."""
