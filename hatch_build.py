"""Builds the workbench's page into the wheel where npm is there; without it all else is built all the same."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class PageHook(BuildHookInterface[Any]):
    """Runs the page's own build before files are gathered; an editable install leaves it to `make page`."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        page = Path(self.root) / "page"
        built = Path(self.root) / "src" / "torsional" / "workbench" / "page" / "index.html"
        if version == "editable" or not page.is_dir() or _is_newer(built, page):
            return
        npm = shutil.which("npm")
        problem = self._built(npm, page) if npm else "npm is not installed"
        if problem:
            self.app.display_warning(f"the workbench's page is left out: {problem}")

    def _built(self, npm: str, page: Path) -> str:
        """What went wrong, in words; nothing if all went well."""
        for command in ([npm, "ci"], [npm, "run", "build"]):
            done = subprocess.run(command, cwd=page, capture_output=True, text=True, check=False)
            if done.returncode:
                return f"{' '.join(command[1:])} failed: {(done.stderr.strip() or done.stdout.strip())[-400:]}"
        return ""


def _is_newer(built: Path, page: Path) -> bool:
    """Whether the page was built since its sources were changed."""
    sources = [file for file in page.rglob("*") if "node_modules" not in file.parts and file.is_file()]
    return built.exists() and all(file.stat().st_mtime <= built.stat().st_mtime for file in sources)
