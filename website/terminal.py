"""What a command prints, as a picture of a terminal.

.venv/bin/python website/terminal.py [folder]
"""

from __future__ import annotations

import re
import subprocess
import sys
from html import escape
from pathlib import Path

FOLDER = Path(__file__).parent.parent / "docs" / "pictures"
COMMANDS = {
    "terminal": ["check column:3", "plan arch:7,thickness=0.3 --hold 1"],
}
"""Name of the picture, and the commands it shows."""
WIDTH, LINE, CHARACTER = 100, 17, 8.0
"""Characters a line; pixels of its height, and of a character's width."""


def picture(commands: list[str]) -> str:
    """The text of an SVG file: each command, and what it prints."""
    lines: list[str] = []
    for command in commands:
        ran = subprocess.run(
            [Path(sys.executable).with_name("drystone"), *command.split()],
            capture_output=True,
            text=True,
        )
        lines += [f"$ drystone {command}", *(_timeless(x) for x in ran.stdout.splitlines()), ""]
    lines = [line[:WIDTH] for line in lines[:-1]]
    rows = "\n".join(
        f'<text x="14" y="{24 + LINE * k}"{_colour(line)}>{escape(line)}</text>'
        for k, line in enumerate(lines)
        if line
    )
    width, height = WIDTH * CHARACTER + 28, LINE * len(lines) + 28
    font = "font:13px ui-monospace,Menlo,Consolas,monospace;white-space:pre;fill:#e3e5e8"
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width:g} {height}" '
        f'width="{width:g}" height="{height}" role="img"><style>text{{{font}}}</style>\n'
        f'<rect width="{width:g}" height="{height}" rx="8" fill="#20282f"/>\n{rows}\n</svg>\n'
    )


def _timeless(line: str) -> str:
    """The line without how long it took, which differs from run to run."""
    return re.sub(r", [\d.]+ \S+ in tests of [\d.]+ [^\s.]+(?=\.)", "", line).rstrip()


def _colour(line: str) -> str:
    return ' style="fill:#79b4e6"' if line.startswith("$") else ""


if __name__ == "__main__":
    folder = Path(sys.argv[1]) if len(sys.argv) > 1 else FOLDER
    for name, commands in COMMANDS.items():
        (folder / f"{name}.svg").write_text(picture(commands))
