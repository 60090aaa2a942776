"""site.py DIRECTORY: makes the references one site that opens from a file, without a network: FORD's pages take Bootstrap from Debian's
copy, and MathJax, for which the module has no formulas, from nowhere; long names wrap. Fails if a link leads nowhere."""

import re
import shutil
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urlsplit

BOOTSTRAP = Path("/usr/share/javascript/bootstrap5")
FILES = ("css/bootstrap.min.css", "js/bootstrap.bundle.min.js")

root = Path(sys.argv[1]).resolve()
fortran = root / "fortran"
for name in FILES:
    shutil.copy(BOOTSTRAP / name, fortran / name)
for page in fortran.rglob("*.html"):
    text = page.read_text(encoding="utf-8")
    text = re.sub(r"<script src=\"[^\"]*MathJax[^>]*></script>", "<style>li{overflow-wrap:anywhere}</style>", text)
    up = "../" * (len(page.relative_to(fortran).parts) - 1)
    text = re.sub(r"\"https://cdn\.jsdelivr\.net/npm/bootstrap@[^/]*/dist/([^\"]*)\"\s+", rf'"{up}\1" ', text)
    text = re.sub(r"\s+integrity=\"[^\"]*\"\s+crossorigin=\"[^\"]*\"", "", text)
    # A list that FORD does not write, because there is one file only.
    page.write_text(re.sub(r"<a href=\"[./]*lists/files\.html\"[^>]*>(.*?)</a>", r"\1", text), encoding="utf-8")


class Links(HTMLParser):
    def __init__(self) -> None:
        super().__init__()
        self.found: list[tuple[str, str]] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found += [(tag, value) for name, value in attrs if name in ("href", "src") and value]


broken, number = [], 0
for page in root.rglob("*.html"):
    links = Links()
    links.feed(page.read_text(encoding="utf-8"))
    for tag, link in links.found:
        parts = urlsplit(link)
        number += 1
        remote = parts.scheme in ("http", "https")
        if (remote and tag != "a") or (not parts.scheme and parts.path and not (page.parent / unquote(parts.path)).exists()):
            broken.append(f"{page.relative_to(root)}: {link}")
if broken or not number:
    sys.exit("\n".join(broken) or "no links")
