"""What was found before: an entry for every study that came out otherwise, which never changes."""
