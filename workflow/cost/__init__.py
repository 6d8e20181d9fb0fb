"""The cost of accuracy: true error and CPU time of a scene, over its tolerance, its settings and its effects."""
