"""Pages for notebooks, and for files outside of docs/ that pages refer to: Markdown as it is, sources as code.

The builder of the site calls `on_files` and `on_page_markdown`.
"""

import base64
import json
import posixpath
import re
from pathlib import Path

from properdocs.structure.files import File, InclusionLevel
from pygments.formatters import HtmlFormatter

ROOT = Path(__file__).resolve().parents[2]
DOCS = "docs"
#: Folder of the site for files that are not in docs/.
SOURCE = "source"

LINK = re.compile(r"(\]\()([^)#\s]+)((?:#[^)\s]*)?\))")
LANGUAGES = {".rs": "rust", ".py": "python", ".sh": "sh", ".toml": "toml", ".json": "json", ".yml": "yaml"}


def in_repository(uri):
    """Returns the path in the repository of a page of the site."""
    if uri.startswith(SOURCE + "/"):
        return uri.removeprefix(SOURCE + "/")
    return posixpath.join(DOCS, uri)


def page_of(path):
    """Returns the page of the site for a path in the repository."""
    if path.startswith(DOCS + "/"):
        return path.removeprefix(DOCS + "/") + (".md" if path.endswith(".ipynb") else "")
    return posixpath.join(SOURCE, path if path.endswith(".md") else path + ".md")


def targets(markdown, uri):
    """Yields the paths in the repository that a page refers to."""
    folder = posixpath.dirname(in_repository(uri))
    for match in LINK.finditer(markdown):
        if "://" not in match[2]:
            yield posixpath.normpath(posixpath.join(folder, match[2]))


def is_code(uri):
    """Returns whether a page shows a file as code."""
    return uri.startswith(SOURCE + "/") and not (ROOT / in_repository(uri)).is_file()


def content(path):
    """Returns the Markdown of a page for a file."""
    text = (ROOT / path).read_text(encoding="utf-8")
    if path.endswith(".md"):
        return text
    fence = "~~~~~~"
    language = LANGUAGES.get(posixpath.splitext(path)[1], "text")
    return f"# {posixpath.basename(path)}\n\n`{path}`\n\n{fence}{language}\n{text}\n{fence}\n"


def shown(output):
    """Returns the Markdown of an output of a notebook."""
    data = output.get("data", {})
    for kind in ("image/png", "image/svg+xml"):
        if kind in data:
            text = "".join(data[kind])
            encoded = text if kind == "image/png" else base64.b64encode(text.encode()).decode()
            return f'<img alt="what the cell shows" src="data:{kind};base64,{encoded.strip()}">'
    if "text/html" in data:
        return f"<div>{''.join(data['text/html'])}</div>"
    text = "".join(output.get("text", data.get("text/plain", "")))
    return f"~~~~~~text\n{text.rstrip()}\n~~~~~~"


def notebook(text):
    """Returns the Markdown of a notebook with its outputs."""
    parts = []
    for cell in json.loads(text)["cells"]:
        source = "".join(cell["source"])
        parts.append(source if cell["cell_type"] == "markdown" else f"~~~~~~python\n{source}\n~~~~~~")
        parts += [shown(output) for output in cell.get("outputs", [])]
    return "\n\n".join(parts)


def on_files(files, *, config):
    """Adds the colours of code, pages of notebooks, and pages of files outside of docs/ that pages refer to, and that these refer to."""
    colors = HtmlFormatter(style="default").get_style_defs(".codehilite")
    files.append(File.generated(config, "site/code.css", content=colors))
    for file in [file for file in files if file.src_uri.endswith(".ipynb")]:
        files.append(File.generated(config, file.src_uri + ".md", content=notebook(file.content_string)))
    waiting = [(page.src_uri, page.content_string) for page in files.documentation_pages()]
    while waiting:
        uri, markdown = waiting.pop()
        for path in targets(markdown, uri):
            page = page_of(path)
            if files.get_file_from_path(page) is None and (ROOT / path).is_file() and not path.startswith(DOCS + "/"):
                made = content(path)
                files.append(File.generated(config, page, content=made, inclusion=InclusionLevel.NOT_IN_NAV))
                if path.endswith(".md"):
                    waiting.append((page, made))
    return files


def on_page_markdown(markdown, *, page, config, files):
    """Turns links to files outside of docs/ into links to their pages."""
    uri = page.file.src_uri
    if is_code(uri):
        return markdown
    here = posixpath.dirname(uri)

    def linked(match):
        if "://" in match[2]:
            return match[0]
        path = posixpath.normpath(posixpath.join(posixpath.dirname(in_repository(uri)), match[2]))
        return match[1] + posixpath.relpath(page_of(path), here or ".") + match[3]

    return LINK.sub(linked, markdown)
