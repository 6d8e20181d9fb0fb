"""A normal force, and a cantilever that pulls."""
