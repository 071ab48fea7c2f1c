"""Hooks of mkdocs: README, CONTRIBUTING and CHANGELOG are pages too, links lead to pages, and headings have the anchors of code hosts."""

import re
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).parent.parent
PAGES = {"index.md": "README.md", "contributing.md": "CONTRIBUTING.md", "changelog.md": "CHANGELOG.md"}


def slug(heading, separator):
    kept = heading.strip().lower().replace(" ", separator)
    return "".join(c for c in kept if c.isalnum() or c in "-_")


def on_config(config):
    config.mdx_configs.setdefault("toc", {})["slugify"] = slug
    return config


def on_files(files, config):
    for page, source in PAGES.items():
        files.append(File.generated(config, page, content=(ROOT / source).read_text()))
    return files


def linked(markdown, page):
    """The page with links to other pages of the site; a link to another file of the repository becomes its path."""
    at_root = page in PAGES
    names = {source: name for name, source in PAGES.items()}

    def link(match):
        text, target = match.groups()
        path, mark, heading = target.partition("#")
        if target.startswith(("http", "#")):
            return match[0]
        source = Path(path.removeprefix("../")) if at_root or path.startswith("../") else Path("docs", path)
        if str(source) in names:
            return f"[{text}]({names[str(source)]}{mark}{heading})"
        if source.parts[0] == "docs" and (ROOT / source).is_file():
            return f"[{text}]({source.relative_to('docs')}{mark}{heading})"
        return f"{text} (`{source}`)"

    return re.sub(r"\[([^\[\]]*)\]\(([^()\s]+)\)", link, markdown)


def on_page_markdown(markdown, page, config, files):
    # Only Python-Markdown needs an empty line above a list, and a break below a picture.
    markdown = re.sub(r"(?m)^(!\[.*\)|<!-- .* -->)$", r"\1\n", markdown)
    lines = []
    is_code = False
    for line in markdown.split("\n"):
        is_code ^= line.startswith("```")
        is_item = line.startswith("* ") or re.match(r"\d+\. ", line)
        before = lines[-1] if lines else ""
        if is_item and not is_code and before and not before.startswith(("* ", "  ")):
            lines.append("")
        lines.append(line)
    return linked("\n".join(lines), page.file.src_uri)
