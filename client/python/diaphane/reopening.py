"""When a stream that broke is opened again."""

import time

from .errors import DiaphaneError

_MAY_COME_BACK = ("UNAVAILABLE", "CANCELLED", "INTERNAL")  # how servers and proxies end what they cannot go on with
_FIRST_PAUSE_S = 0.05
_LONGEST_PAUSE_S = 1.0


class Reopening:
    """Pauses between attempts, longer each time, for at most `timeout_s` after the last success. One thread."""

    def __init__(self, timeout_s: float):
        self._timeout_s = timeout_s
        self._broken_since: float | None = None
        self._pause_s = _FIRST_PAUSE_S

    def succeeded(self) -> None:
        self._broken_since = None

    def wait_after(self, error: DiaphaneError) -> None:
        """Raises `error` where trying again cannot help, or has been tried for long enough."""
        now = time.monotonic()
        if self._broken_since is None:
            self._broken_since = now
            self._pause_s = _FIRST_PAUSE_S
        if error.code not in _MAY_COME_BACK or now - self._broken_since >= self._timeout_s:
            raise error
        time.sleep(self._pause_s)
        self._pause_s = min(2 * self._pause_s, _LONGEST_PAUSE_S)
