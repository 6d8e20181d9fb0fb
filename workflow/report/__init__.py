"""One HTML page for a run, several runs or a sweep: what was asked, what came out, figures that answer to the hand."""
