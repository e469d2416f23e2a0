"""Names the case of a test that runs through several; unittest's own sub-tests do not reach rosunit's result file."""

import contextlib


@contextlib.contextmanager
def case(*name):
    try:
        yield
    except AssertionError as error:
        raise AssertionError(f"case {', '.join(map(repr, name))}: {error}") from error
    except Exception as error:
        raise RuntimeError(f"case {', '.join(map(repr, name))}") from error
