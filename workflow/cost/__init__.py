"""What accuracy costs in time: every numerical knob of a scene, its error beside its CPU time, measured in one run."""
