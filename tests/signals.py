"""Children that hear Ctrl-C although what runs the tests, as a job in the background, is deaf to it."""

import signal


def listening() -> None:
    """To be done by a child before its program begins: as from a terminal."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
