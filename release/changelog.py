"""What the changelog says of a version: the text of its release.

python release/changelog.py v0.2.0            print it
python release/changelog.py --check v0.2.0    and refuse a tag that is not the packages' version
"""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
HEADING = re.compile(r"^## (\S+)(?: - (\d{4}-\d{2}-\d{2}))?$", re.MULTILINE)


class ChangelogError(Exception):
    """A version cannot be released as things are; the text says what to mend."""


def main() -> None:
    arguments = sys.argv[1:]
    checked = arguments[:1] == ["--check"]
    if len(arguments) != 1 + checked:
        sys.exit(__doc__)
    try:
        text = section((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), arguments[-1])
        if checked:
            check((ROOT / "Cargo.toml").read_text(encoding="utf-8"), arguments[-1])
    except ChangelogError as error:
        sys.exit(f"changelog: {error}")
    print(text)


def section(changelog: str, tag: str) -> str:
    """The part of the version of a tag such as "v0.2.0", without its heading."""
    version = _version(tag)
    headings = list(HEADING.finditer(changelog))
    for k, heading in enumerate(headings):
        if heading[1] == version:
            if heading[2] is None:
                raise ChangelogError(f"{version} has no date: write ## {version} - YYYY-MM-DD")
            end = headings[k + 1].start() if k + 1 < len(headings) else len(changelog)
            return changelog[heading.end() : end].strip()
    raise ChangelogError(f"CHANGELOG.md has no section ## {version} - YYYY-MM-DD")


def check(cargo: str, tag: str) -> None:
    """Whether the workspace's version is that of the tag."""
    declared = re.search(r'^version = "(.+)"$', cargo, re.MULTILINE)
    if declared is None or declared[1] != _version(tag):
        is_now = "missing" if declared is None else declared[1]
        raise ChangelogError(f"the tag is {tag}, but the version in Cargo.toml is {is_now}")


def _version(tag: str) -> str:
    if not re.fullmatch(r"v\d+\.\d+\.\d+", tag):
        raise ChangelogError(f"{tag}: a release's tag is v and three numbers, as in v0.2.0")
    return tag[1:]


if __name__ == "__main__":
    main()
