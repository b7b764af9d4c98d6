"""Modules of tools/docs: from the pages of the repository to the sources of the site."""
