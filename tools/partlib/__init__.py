"""Modules of tools/part_pictures."""
