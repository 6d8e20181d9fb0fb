"""Fitting a measured force curve: any parameter of a scene, with intervals that hold."""
