"""Prescribed displacement."""
