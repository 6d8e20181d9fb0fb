"""From a scene to a finished run folder: passes, files, figures, scales."""
