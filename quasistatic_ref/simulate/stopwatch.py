"""Wall time of the parts of a step."""

import time


class Stopwatch:
    """Wall time between laps, by name."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._last = time.perf_counter()

    def __call__(self, name: str) -> None:
        """End the lap of that name."""
        now = time.perf_counter()
        self.seconds[name], self._last = now - self._last, now
