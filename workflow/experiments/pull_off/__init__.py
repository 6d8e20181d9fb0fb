"""Compression, then the largest tension held."""
