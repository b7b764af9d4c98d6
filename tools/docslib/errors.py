"""What ends tools/docs with a message and exit status 1."""


class DocsError(Exception):
    """One sentence for each fault, a line each."""
