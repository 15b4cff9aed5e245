"""The files of the built page, taken into memory once: what is not among them is not there."""

from __future__ import annotations

import gzip
from dataclasses import dataclass
from pathlib import Path

from torsional.errors import ModelError

HERE = Path(__file__).parent / "page"
TYPES = {
    ".html": "text/html; charset=utf-8",
    ".js": "text/javascript; charset=utf-8",
    ".css": "text/css; charset=utf-8",
    ".svg": "image/svg+xml",
    ".png": "image/png",
    ".ico": "image/x-icon",
    ".woff2": "font/woff2",
    ".json": "application/json",
    ".txt": "text/plain; charset=utf-8",
    ".webmanifest": "application/manifest+json",
}
"""What the page may be made of; other files of the folder, source maps for one, are not served."""
PACKED = (".html", ".js", ".css", ".svg", ".json", ".txt", ".webmanifest")


@dataclass(frozen=True)
class File:
    """One file: its ``kind``, its bytes plain and packed (the same where packing gains nothing), whether its name tells
    its content, so that it never changes."""

    kind: str
    plain: bytes
    packed: bytes
    lasting: bool

    def headers(self, packing: bool) -> dict[str, str]:
        """Headers of the file for one who understands gzip, or does not."""
        kept = "public, max-age=31536000, immutable" if self.lasting else "no-cache"
        packed = {"content-encoding": "gzip"} if packing and self.packed is not self.plain else {}
        return {"content-type": self.kind, "cache-control": kept, "vary": "accept-encoding", **packed}


def built_page(folder: Path) -> dict[str, File]:
    """The files by the paths under which they are asked for; "/" is the page itself.

    Raises ModelError where the page has not been built.
    """
    if not (folder / "index.html").is_file():
        raise ModelError(
            "the page of the workbench has not been built",
            remedy="'make page' builds it where Node and npm are installed; a wheel that was built with them holds it",
        )
    found = {
        "/" + path.relative_to(folder).as_posix(): _file(path, path.parent.name == "assets")
        for path in sorted(folder.rglob("*"))
        if path.is_file() and path.suffix in TYPES
    }
    return {**found, "/": found["/index.html"]}


def _file(path: Path, lasting: bool) -> File:
    plain = path.read_bytes()
    packed = gzip.compress(plain, 9, mtime=0) if path.suffix in PACKED else plain
    return File(TYPES[path.suffix], plain, packed if len(packed) < len(plain) else plain, lasting)
