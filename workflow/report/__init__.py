"""HTML pages of a run, several runs or a sweep, with interactive figures; animations of a run."""
