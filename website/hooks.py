"""What MkDocs does besides: see https://www.mkdocs.org/user-guide/configuration/#hooks.

- Links that lead out of `docs/` (the pages are read in the repository as well) lead to the
  repository.
- `<!-- gallery -->` becomes the gallery: every program of `examples/gallery` beside its picture.
- `<!-- table: name -->` and `<!-- plot: name: text -->` become what is in `benchmarks/results`.
- The crates' own documentation, if `cargo doc` has made it, is in `rust/`.
- Notebooks are run as `website/jupyter` says.
"""

from __future__ import annotations

import os
import re
import sys
from pathlib import Path
from typing import TYPE_CHECKING

sys.path.insert(0, str(Path(__file__).parent))

from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

import benchmark_results
import gallery

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig

ROOT = Path(__file__).parent.parent
LINK = re.compile(r"(\]\(|src=\"|href=\")((?:\.\./)+[^)\s\"#]+)(#[^)\s\"]*)?")
RUSTDOC = ROOT / "out" / "rustdoc"
"""`rust/` in it is what `cargo doc` has made."""
CRATES = ("drystone", "drystone_lcp", "drystone_contact")

CONFIGURED = "JUPYTER_CONFIG_PATH"
os.environ[CONFIGURED] = os.pathsep.join(
    filter(None, (str(ROOT / "website" / "jupyter"), os.environ.get(CONFIGURED)))
)


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Plots of the benchmarks are files of the site, though not of the repository."""
    for name, svg in benchmark_results.plots().items():
        files.append(File.generated(config, f"benchmarks/{name}.svg", content=svg))
    for path in (RUSTDOC / "rust").rglob("*"):
        if path.is_file() and path.suffix != ".md":  # a font's licence, which is no page
            uri = path.relative_to(RUSTDOC).as_posix()
            files.append(File(uri, str(RUSTDOC), config.site_dir, use_directory_urls=True))
    for crate in CRATES:
        uri = f"rust/{crate}/index.html"
        if uri not in files.src_uris:
            files.append(File.generated(config, uri, content=f"{crate}: `make docs` builds this."))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Fill in what is made here, and lead links out of `docs/` to the repository."""
    markdown = markdown.replace("<!-- gallery -->", gallery.markdown())
    markdown = re.sub(
        r"<!-- table: (\w+) -->", lambda found: benchmark_results.table(found[1]), markdown
    )
    markdown = re.sub(r"<!-- plot: (\w+): (.*) -->", r"![\2](benchmarks/\1.svg)", markdown)
    folder = (ROOT / "docs" / page.file.src_uri).parent

    def outward(found: re.Match[str]) -> str:
        target = (folder / found[2]).resolve()
        if target.is_relative_to(ROOT / "docs") or not target.exists():
            return found[0]
        kind = "tree" if target.is_dir() else "blob"
        where = f"{config.repo_url}/{kind}/main/{target.relative_to(ROOT)}"
        return f"{found[1]}{where}{found[3] or ''}"

    return LINK.sub(outward, markdown)
