"""pages.py DIRECTORY: the documents as pages of the site, with figures, formulas as MathML, and a search over all sections and functions.
Everything opens from a file, without a network. Links to files of the repository lead to copies of them."""

import html
import json
import re
import shutil
import sys
from pathlib import Path

import markdown
from latex2mathml.converter import convert

ORDER = ("README docs/guide docs/spring-sliders fortran_examples/README docs/identification docs/cluster docs/validation docs/accuracy "
         "docs/benchmarks docs/derivation docs/paper docs/architecture docs/extending CONTRIBUTING CHANGELOG").split()  # fmt: skip
REFERENCES = {"c/index.html": "C reference", "fortran/index.html": "Fortran reference", "rust/microslip/index.html": "Rust reference"}
STYLE = """body{font:16px/1.5 sans-serif;max-width:60em;margin:auto;padding:0 1em 4em;color:#222}nav{border-bottom:1px solid #ccc;padding:.6em 0}
nav a{margin-right:.8em;white-space:nowrap}img{max-width:100%}table{border-collapse:collapse;margin:1em 0}td,th{border:1px solid #ccc;padding:.2em .5em}
td[style*=right]{white-space:nowrap}pre{background:#f5f5f5;padding:.6em;overflow:auto;font-size:.8em}
#found{background:#fffbe6}#query{font-size:1em;width:18em}math{font-size:1.1em}math[display=block]{margin:.6em 0}"""
SEARCH = """function find(text){const words=text.toLowerCase().split(/\\s+/).filter(w=>w),has=t=>words.every(w=>t.toLowerCase().includes(w))
document.getElementById('found').innerHTML=words.length?sections.filter(s=>has(s[0]+s[2])).sort((a,b)=>has(b[0])-has(a[0])).slice(0,99)
.map(s=>'<p><a href="'+up+s[1]+'">'+s[0]+'</a></p>').join('')||'<p>nothing</p>':''}"""

site = Path(sys.argv[1]).resolve()
root = Path(__file__).resolve().parents[2]
folders = ("*.md", "docs/*.md", "packaging/*.md", "*/README.md", "*/*/README.md")
documents = sorted({str(path.relative_to(root)) for folder in folders for path in root.glob(folder) if "target" not in path.parts})
titles = {f"{name}.html": (root / f"{name}.md").read_text(encoding="utf-8").partition("\n")[0].strip("# ") for name in ORDER}
sections: list[tuple[str, str, str]] = []


def slug(heading: str, _: str) -> str:  # the anchors of tools/links.sh
    return re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-")


def page(name: str) -> str:
    formulas: list[str] = []

    def formula(match: re.Match[str]) -> str:
        spaced = re.sub(r"\\(ln|sin|cos)(\^\d)?", r"\\,\g<0>\\,", match[1] or match[2] or match[3])
        formulas.append(convert(spaced, display="block" if match[0].startswith(("$$", "```")) else "inline"))
        return f"FORMULA{len(formulas) - 1}END"

    text = (root / name).read_text(encoding="utf-8")
    text = re.sub(r"\$\$(.*?)\$\$|```math\n(.*?)```|\$`(.*?)`\$", formula, text, flags=re.S)
    body = markdown.markdown(text, extensions=["tables", "fenced_code", "toc", "sane_lists"], extension_configs={"toc": {"slugify": slug}})
    body = re.sub(r"FORMULA(\d+)END", lambda match: formulas[int(match[1])], body).replace("\\|", "|")  # of code in tables
    up = "../" * name.count("/")

    def link(match: re.Match[str]) -> str:
        kind, target = match[1], match[2]
        path, _, anchor = target.partition("#")
        if not path or re.match(r"\w+:|&", path):
            return match[0]
        place = ((root / name).parent / path).resolve().relative_to(root)
        if place.suffix == ".md":
            return f'{kind}="{up}{place.with_suffix(".html")}{"#" + anchor if anchor else ""}"'
        if (root / place).is_dir():
            readme = place / "README.md"
            return f'{kind}="{up}{readme.with_suffix(".html")}"' if str(readme) in documents else 'data-folder=""'
        (site / place).parent.mkdir(parents=True, exist_ok=True)
        shutil.copy(root / place, site / place)
        return f'{kind}="{up}{place}"'

    body = re.sub(r'\b(href|src)="([^"]*)"', link, body)
    title = re.sub(r"<[^>]*>", "", re.search(r"<h1[^>]*>(.*?)</h1>", body)[1])
    for anchor, heading, rest in re.findall(r'<h[1-3] id="([^"]*)">(.*?)</h[1-3]>(.*?)(?=<h[1-3]|\Z)', body, flags=re.S):
        plain = html.unescape(re.sub(r"<[^>]*>", " ", rest))
        sections.append((f"{title}: {re.sub('<[^>]*>', '', heading)}", f"{Path(name).with_suffix('.html')}#{anchor}", plain))
    links = " ".join(f'<a href="{up}{target}">{html.escape(heading)}</a>' for target, heading in (titles | REFERENCES).items())
    return f"""<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style></head><body>
<nav>{links}<br><input id="query" placeholder="search all documents" oninput="find(this.value)"></nav><div id="found"></div>
{body}
<script>const up = "{up}";</script><script src="{up}search.js"></script></body></html>
"""


for name in documents:
    target = site / Path(name).with_suffix(".html")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(page(name), encoding="utf-8")
functions = (site / "c/globals_func.html").read_text(encoding="utf-8")
sections += [(f"C reference: {name}", f"c/{link}", "") for name, link in re.findall(r'<li>(mslip_\w+)\(\).*?href="([^"]*)', functions)]
(site / "search.js").write_text(f"const sections = {json.dumps(sections)};\n{SEARCH}\n", encoding="utf-8")
shutil.copy(site / "README.html", site / "index.html")
