"""Every number that a scene leaves open."""
