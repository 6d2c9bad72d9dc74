"""Shows a page or a picture: below the cell of a notebook, from a script in the browser."""

from __future__ import annotations

import sys
import tempfile
import webbrowser
from pathlib import Path

from drystone.viewer.page import Page


def show(thing: object, page: Page | None) -> None:
    """Show `page`, or, where there is none, the picture of the thing."""
    if _in_notebook():
        from IPython.display import display

        display(thing if page is None else page)
        return
    # It stays there after the script has ended: the browser reads it then.
    folder = Path(tempfile.mkdtemp(prefix="drystone-"))
    if page is None:
        from drystone import pictures

        path = folder / "picture.svg"
        pictures.save(pictures.figure_of(thing), path)
    else:
        path = folder / "page.html"
        page.save(path)
    if not webbrowser.open(path.as_uri()):
        print(f"no browser could be opened: look at {path}", file=sys.stderr)


def _in_notebook() -> bool:
    """Whether cells show what is displayed: in IPython's terminal they do not."""
    if "IPython" not in sys.modules:
        return False
    from IPython import get_ipython

    return hasattr(get_ipython(), "kernel")
