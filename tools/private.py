"""Private copies of the checkout with compiled code of their own: a changed source meets no old machine code."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
LEFT_OUT = (".git", ".venv*", "__pycache__", ".*_cache", ".hypothesis", ".benchmarks", "out", "_build", "_generated")


class Copy:
    """A copy of the checkout in ``folder``: its ``tree``, and ``kept``, the machine code of the unchanged sources."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.tree = folder, folder / "tree"
        self.kept, self.cache = folder / "kept", folder / "cache"
        self.sources = self.tree / "src"
        if not self.tree.is_dir():
            shutil.copytree(ROOT, self.tree, ignore=shutil.ignore_patterns(*LEFT_OUT), symlinks=True)
            (self.tree / ".git").mkdir()  # some tests ask for the root of a checkout

    def environment(self, cache: Path, **more: str) -> dict[str, str]:
        """Variables of a process that imports this copy and keeps its machine code in ``cache``."""
        paths = os.pathsep.join(str(path) for path in (self.sources, self.tree, self.tree / "tools"))
        threads = dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
        own = {"PYTHONPATH": paths, "NUMBA_CACHE_DIR": str(cache), "MPLBACKEND": "Agg", "PYTHONHASHSEED": "0"}
        return {**os.environ, **threads, **own, **more}

    def pytest(self, *words: str) -> list[str]:
        """The command of a test run in this copy."""
        return [sys.executable, "-m", "pytest", "--no-header", f"--basetemp={self.folder / 'tmp'}", *words]

    def take_machine_code(self, other: Copy) -> None:
        """Copies what another copy has kept: numba names each folder after the path of its sources."""
        shutil.rmtree(self.kept, ignore_errors=True)
        for folder in sorted((other.sources / "torsional").rglob("*")):
            source = other.kept / _kept_name(folder)
            if folder.is_dir() and source.is_dir():
                shutil.copytree(source, self.kept / _kept_name(self.sources / folder.relative_to(other.sources)))

    def without(self, outdated: set[str]) -> Path:
        """A cache with what was kept, but for the machine code of the ``outdated`` files (below the sources)."""
        shutil.rmtree(self.cache, ignore_errors=True)
        prefixes = {(_kept_name((self.sources / name).parent), Path(name).stem + ".") for name in outdated}
        for folder in sorted(self.kept.iterdir()) if self.kept.is_dir() else []:
            (self.cache / folder.name).mkdir(parents=True)
            dropped = tuple(stem for name, stem in prefixes if name == folder.name)
            for file in folder.iterdir():
                if not file.name.startswith(dropped or "\0"):
                    # numba replaces its files and never writes in them, so what is kept stays as it is
                    os.link(file, self.cache / folder.name / file.name)
        return self.cache


def _kept_name(folder: Path) -> str:
    return f"{folder.name}_{hashlib.sha1(str(folder).encode()).hexdigest()}"


def stopped(process: subprocess.Popen[str]) -> None:
    """Ends a process and all that it started."""
    import signal

    os.killpg(process.pid, signal.SIGKILL)
    process.wait()
