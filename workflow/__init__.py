"""From a scene file to a finished run folder."""
