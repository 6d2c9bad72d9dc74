"""Whether every link within the built site leads somewhere, to a page and to a place on it.

    .venv/bin/python website/check_links.py out/site

Exit status 1, with a line for each link that does not. Pages of `cargo doc` are led to, not read.
"""

from __future__ import annotations

import sys
from functools import cache
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit


class Links(HTMLParser):
    """The links and the identifiers of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self.places: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Called for each element."""
        for name, value in attrs:
            if value and name in ("href", "src"):
                self.found.append(value)
            if value and (name == "id" or (tag == "a" and name == "name")):
                self.places.add(value)


@cache
def read(path: Path) -> Links:
    """What a page holds."""
    links = Links()
    links.feed(path.read_text())
    return links


def broken(site: Path) -> list[str]:
    """One line for each link that leads nowhere."""
    lines = []
    for page in sorted(site.rglob("*.html")):
        if site / "rust" in page.parents or page.name == "404.html":
            continue
        for link in read(page).found:
            parts = urlsplit(link)
            if parts.scheme or parts.netloc:
                continue
            target = (page.parent / unquote(parts.path)).resolve() if parts.path else page
            target = target / "index.html" if target.is_dir() else target
            if not target.is_file():
                lines.append(f"{page.relative_to(site)}: {link}")
            elif _lost(target, unquote(parts.fragment), site):
                lines.append(f"{page.relative_to(site)}: {link} (no such place)")
    return lines


def _lost(target: Path, place: str, site: Path) -> bool:
    if not place or target.suffix != ".html" or site / "rust" in target.parents:
        return False
    return place not in read(target).places and not place.startswith("__")


if __name__ == "__main__":
    lines = broken(Path(sys.argv[1]).resolve())
    print("\n".join(lines) or "no broken link")
    sys.exit(bool(lines))
