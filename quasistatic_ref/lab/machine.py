"""The machine that something was measured on, recorded with its times."""

import os
import platform
from pathlib import Path

CPU = Path("/sys/devices/system/cpu/cpu0")
UNKNOWN = "unknown"
"""What stands for a fact that the system does not report."""


def machine() -> dict[str, object]:
    """Processor, cores, caches, governor of its frequency, memory, system, Python, the load."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "caches": _caches(),
        "governor": _text(CPU / "cpufreq" / "scaling_governor") or UNKNOWN,
        "memory [GB]": round(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") / 1e9, 1),
        "system": f"{platform.system()} {platform.release()}",
        "python": platform.python_version(),
        "load": " ".join(f"{one:.2f}" for one in os.getloadavg()),
    }


def _text(path: Path) -> str:
    try:
        return path.read_text().strip()
    except OSError:
        return ""


def _caches() -> str:
    """Sizes by level and kind, such as ``L1 data 32K``."""
    caches = []
    for folder in sorted((CPU / "cache").glob("index*")):
        kind = _text(folder / "type").lower().replace("unified", "")
        caches.append(f"L{_text(folder / 'level')} {kind}".strip() + f" {_text(folder / 'size')}")
    return ", ".join(caches) or UNKNOWN


def _processor() -> str:
    try:
        for line in Path("/proc/cpuinfo").read_text().splitlines():
            if line.startswith("model name"):
                return line.partition(":")[2].strip()
    except OSError:
        pass
    return platform.processor() or platform.machine()
