"""One HTML page for a run, several runs or a sweep: the scene, the results, interactive figures."""
