"""A hook of MkDocs: the files of the repository that pages link to are part of the site, in its folder `repository`."""

import posixpath
import re
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files
from mkdocs.structure.pages import Page

ROOT = Path(__file__).parents[2]
TOP = {"index.md": "README.md", "validation.md": "VALIDATION.md"}
"""Pages that have nothing but a file at the top of the repository."""
LINK = re.compile(r"(?<=\]\()[^)#:]+")


def source(page: str) -> tuple[str, str]:
    """Return the text of a page and the folder of the repository to which its links are relative."""
    if page in TOP:
        return (ROOT / TOP[page]).read_text("utf-8"), ""
    return (ROOT / "docs" / page).read_text("utf-8"), posixpath.join("docs", posixpath.dirname(page))


def linked(link: str, folder: str) -> tuple[Path | None, str]:
    """Return the file of the repository, or None for one of the site, and the path in the site that a link leads to."""
    path = posixpath.normpath(posixpath.join(folder, link))
    while (ROOT / path).is_dir():  # a folder is described by the file above it
        path = posixpath.join(posixpath.dirname(path), "README.md")
    for page, top in TOP.items():
        if path == top:
            return None, page
    if path.startswith("docs/") or not (ROOT / path).is_file():
        return None, path.removeprefix("docs/")
    return ROOT / path, f"repository/{path}" + ".txt" * path.endswith(".md")


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the files that pages link to."""
    for page in list(files.documentation_pages()):
        text, folder = source(page.src_uri)
        for link in LINK.findall(text):
            path, uri = linked(link, folder)
            if path and uri not in files.src_uris:
                files.append(File.generated(config, uri, abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, page: Page, config: MkDocsConfig, files: Files) -> str:
    """Return the text of a page with its links as the site needs them."""
    text, folder = source(page.file.src_uri)
    here = posixpath.dirname(page.file.src_uri) or "."
    return LINK.sub(lambda link: posixpath.relpath(linked(link[0], folder)[1], here), text)
