"""Make the links of an sdist's README absolute: PyPI shows it without the repository around it.

    python release/readme.py dist/drystone-0.2.0.tar.gz

The sdist is written anew, with the same bytes every time. Wheels are built from it, and so have
the same text.
"""

from __future__ import annotations

import gzip
import io
import re
import sys
import tarfile
from pathlib import Path

SHOWN = ("README.md", "PKG-INFO")
"""Files at the top of an sdist that hold the text."""


class ReadmeError(Exception):
    """An sdist is not as expected; the text says how."""


def main() -> None:
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        rewrite(Path(sys.argv[1]))
    except ReadmeError as error:
        sys.exit(f"readme: {error}")


def rewrite(sdist: Path) -> None:
    """Replace the texts within an sdist."""
    packed = io.BytesIO()
    changed = 0
    with (
        tarfile.open(sdist) as old,
        gzip.GzipFile(filename="", fileobj=packed, mode="wb", mtime=0) as stream,
        tarfile.open(fileobj=stream, mode="w", format=tarfile.PAX_FORMAT) as new,
    ):
        address, version = _repository(old), _version(sdist)
        for entry in old:
            file = old.extractfile(entry)
            data = b"" if file is None else file.read()
            if entry.name.count("/") == 1 and entry.name.endswith(SHOWN):
                data = absolute(data.decode(), address, version).encode()
                entry.size = len(data)
                changed += 1
            new.addfile(entry, io.BytesIO(data))
    if changed != len(SHOWN):
        raise ReadmeError(f"{sdist.name} holds {changed} of {', '.join(SHOWN)}")
    sdist.write_bytes(packed.getvalue())


def absolute(text: str, address: str, version: str) -> str:
    """Links and pictures of a text as they are on the repository's site, at this version."""
    commit = "main" if "dev" in version else f"v{version}"
    outside = r"(?!https?:|#|mailto:)"
    text = re.sub(rf"\]\({outside}", f"]({address}/blob/{commit}/", text)
    return re.sub(rf'(src|srcset)="{outside}', rf'\1="{address}/raw/{commit}/', text)


def _repository(sdist: tarfile.TarFile) -> str:
    """The address in the workspace's Cargo.toml."""
    for entry in sdist:
        if entry.name.count("/") == 1 and entry.name.endswith("/Cargo.toml"):
            file = sdist.extractfile(entry)
            text = "" if file is None else file.read().decode()
            found = re.search(r'^repository = "(.+)"$', text, re.MULTILINE)
            if found is not None:
                return found[1]
    raise ReadmeError("its Cargo.toml names no repository")


def _version(sdist: Path) -> str:
    return sdist.name.removeprefix("drystone-").removesuffix(".tar.gz")


if __name__ == "__main__":
    main()
