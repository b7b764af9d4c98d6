"""Modules of tools/results."""
