"""The cost of accuracy: error and CPU time of every numerical setting of a scene, measured in one run."""
