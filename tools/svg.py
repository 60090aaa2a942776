"""svg.py < PICTURE > SMALLER: a picture of gnuplot without what nobody sees: points of curves within 0.1 of a chord, markers on
markers, digits beyond the first decimal, empty groups, unused symbols and filters, the version of the program."""

import re
import sys


def simplified(points: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Ramer, Douglas and Peucker: chords from which no point is further than 0.1."""
    (x0, y0), (x1, y1) = points[0], points[-1]
    length = ((x1 - x0) ** 2 + (y1 - y0) ** 2) ** 0.5

    def distance(x: float, y: float) -> float:
        return abs((x1 - x0) * (y - y0) - (y1 - y0) * (x - x0)) / length if length else ((x - x0) ** 2 + (y - y0) ** 2) ** 0.5

    far, index = max(((distance(*point), i) for i, point in enumerate(points)))
    return simplified(points[: index + 1])[:-1] + simplified(points[index:]) if far > 0.1 else [points[0], points[-1]]


def curve(match: re.Match[str]) -> str:
    lines = []
    for line in match[1].split("M")[1:]:
        points = [tuple(map(float, point.split(","))) for point in re.findall(r"[-\d.]+,[-\d.]+", line)]
        points = simplified(points) if len(points) > 2 else points
        lines.append("M" + " ".join(f"{x:.1f},{y:.1f}".replace(".0", "") for x, y in points) + ("Z" if "Z" in line else ""))
    return f" d='{''.join(lines)}'"


text = sys.stdin.read()
text = re.sub(r"<(desc|title|filter)\b.*?</\1>\s*", "", text, flags=re.S)
text = re.sub(r"(?<=\S)\s*\n\s*(?=[^<\s])", " ", text)  # one element a line
text = re.sub(r"\s+d='(M[^']*)'", curve, text)
text = re.sub(r"(?<=translate\()([-\d.]+),\s*([-\d.]+)", lambda m: f"{float(m[1]):.1f},{float(m[2]):.1f}", text)
seen: set[tuple[str, ...]] = set()


def marker(match: re.Match[str]) -> str:
    """A marker that hides another one by about six units is drawn once."""
    key = (match[1], str(round(float(match[2]) / 6)), str(round(float(match[3]) / 6)), match[4])
    return "" if key in seen or seen.add(key) else match[0]


text = re.sub(r"<use xlink:href='(#\w+)' transform='translate\(([-\d.]+),([-\d.]+)\)([^>]*)/>", marker, text)
text = re.sub(r"rgb\(\s*(\d+),\s*(\d+),\s*(\d+)\)", lambda m: f"#{int(m[1]):02x}{int(m[2]):02x}{int(m[3]):02x}", text)
text = re.sub(r"<tspan[^>]*>\s*</tspan>", "", text)
while (smaller := re.sub(r"<g\b[^>]*>\s*</g>\s*", "", text)) != text:
    text = smaller
for symbol in re.findall(r"\bid='(gpPt\d+|gpDot)'", text)[::-1]:
    if f"#{symbol}'" not in text:
        text = re.sub(rf"\s*<\w+ [^<]*\bid='{symbol}'[^>]*/>", "", text)
text = re.sub(r"\s*\n\s*(?=</)|(?<=>)\s*\n\s*(?=<(?:text|tspan|path|polygon|rect)\b)|(?<=/>)[ \t]+", "", text)  # a group a line
sys.stdout.write(re.sub(r"\s*\n\s*", "\n", text))
