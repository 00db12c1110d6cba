"""Tables and figures → one page that needs nothing else; templates and styles are in ``report/``."""
