//! Pictures: rows of one or two panels, axes with units, and a legend. A stroke has the same meaning in all panels of a picture.
//! Margins and width follow from the widths of the texts.

use crate::canvas::{Point, Stroke, Svg, text_width};
use crate::number::format_number;
use crate::units::{Quantity, Units};
use std::collections::HashSet;
use std::ops::Range;

#[derive(Debug)]
pub struct Picture {
    /// Parameters of the contact.
    pub caption: String,
    pub units: Units,
    pub rows: Vec<Row>,
}

/// Panels side by side.
#[derive(Debug)]
pub struct Row {
    pub panels: Vec<Panel>,
    /// Whether both axes of a panel have the same scale.
    pub equal_scales: bool,
}

#[derive(Debug)]
pub struct Panel {
    pub x: Axis,
    pub y: Axis,
    pub lines: Vec<Line>,
}

#[derive(Debug, Clone, Copy)]
pub struct Axis {
    /// Words separated by blanks, or as in a table.
    pub name: &'static str,
    pub quantity: Quantity,
    pub logarithmic: bool,
}

#[derive(Debug)]
pub struct Line {
    /// Number of the stroke, which has the same meaning in all panels.
    pub stroke: usize,
    /// Entry of the legend; empty for a line without an entry, or with one in another panel.
    pub name: String,
    /// The line is interrupted at points that are not finite.
    pub points: Vec<Point>,
}

impl From<Panel> for Row {
    fn from(panel: Panel) -> Row {
        Row { panels: vec![panel], equal_scales: false }
    }
}

impl Axis {
    pub const fn linear(name: &'static str, quantity: Quantity) -> Axis {
        Axis { name, quantity, logarithmic: false }
    }

    pub const fn logarithmic(name: &'static str, quantity: Quantity) -> Axis {
        Axis { name, quantity, logarithmic: true }
    }

    /// The power of ten of the unit for values of this size in SI units, and the label.
    fn label(&self, size: f64) -> (i32, String) {
        let (power, unit) = prefixed(size, self.quantity);
        (power, format!("{} [{unit}]", self.name.replace('_', " ")))
    }
}

/// Width of the graph of a row of one panel, and heights of graphs in rows of one panel and of two.
const GRAPH_WIDTH: f64 = 680.0;
const GRAPH_HEIGHTS: [f64; 2] = [338.0, 258.0];
const CAPTION_HEIGHT: f64 = 36.0;
/// Height of tick labels and label of an x axis, with the distance to the next row.
const BELOW_GRAPH: f64 = 62.0;
const LINE_HEIGHT: f64 = 24.0;
/// Between texts, graphs and edges of the picture.
const PADDING: f64 = 12.0;
/// Length of a line in the legend.
const KEY_LENGTH: f64 = 34.0;
const TICK_LENGTH: f64 = 4.0;
/// Least distances of ticks along x and y: tick labels have at most about five characters, and one line.
const TICK_DISTANCES: [f64; 2] = [55.0, 30.0];

/// The first four colours also differ in grey.
const DASHES: [Option<[f32; 2]>; 4] = [None, Some([14.0, 6.0]), Some([5.0, 4.0]), Some([2.0, 4.0])];
const COLOURS: [u32; 8] = [0x000000, 0x005ab4, 0xc84600, 0x008c64, 0xe19600, 0x823296, 0x46aae1, 0xd75a96];
const AXIS: Stroke = Stroke { colour: [0, 0, 0], width: 1.0, dash: None };
const GRID: Stroke = Stroke { colour: [214, 214, 214], width: 1.0, dash: None };

/// Each pair of a dash and a colour once in 32 numbers: after four lines the colours are shifted by one against the dashes.
fn stroke(number: usize) -> Stroke {
    let [_, colour @ ..] = COLOURS[(number + number / DASHES.len()) % COLOURS.len()].to_be_bytes();
    Stroke { colour, width: 2.0, dash: DASHES[number % DASHES.len()] }
}

/// A panel, its axes, and the size of its graph.
struct Graph<'a> {
    panel: &'a Panel,
    x: Scale,
    y: Scale,
    width: f64,
    height: f64,
}

impl Picture {
    /// The content of an SVG file.
    pub fn draw(&self) -> String {
        let rows: Vec<Vec<Graph>> = self.rows.iter().map(|row| self.graphs(row)).collect();
        let left = rows.iter().map(|row| row[0].margin()).fold(0.0, f64::max);
        let right = left + GRAPH_WIDTH;
        let legend = self.legend();
        let names = legend.iter().map(|line| text_width(&line.name)).fold(0.0, f64::max);
        let of_legend = if legend.is_empty() { 0.0 } else { KEY_LENGTH + PADDING + names + PADDING };
        let width = (right + 2.0 * PADDING + of_legend).max(text_width(&self.caption) + 2.0 * PADDING);
        let height: f64 = rows.iter().map(|row| row[0].height + BELOW_GRAPH).sum();
        let height = CAPTION_HEIGHT + height.max(LINE_HEIGHT * legend.len() as f64);

        let mut svg = Svg::new((width.ceil() as u32, height.ceil() as u32));
        svg.text(&self.caption, (PADDING, 0.5 * CAPTION_HEIGHT), 0.0, false);
        let mut top = CAPTION_HEIGHT;
        for row in &rows {
            row[0].draw_on(&mut svg, (left, top));
            if let Some(second) = row.get(1) {
                second.draw_on(&mut svg, (right - second.width, top));
            }
            top += row[0].height + BELOW_GRAPH;
        }
        let start = right + 2.0 * PADDING;
        for (i, line) in legend.iter().enumerate() {
            let middle = CAPTION_HEIGHT + LINE_HEIGHT * (i as f64 + 0.5);
            svg.lines(&[vec![(start, middle), (start + KEY_LENGTH, middle)]], &stroke(line.stroke));
            svg.text(&line.name, (start + KEY_LENGTH + PADDING, middle), 0.0, false);
        }
        svg.finish()
    }

    /// The first line of each name.
    fn legend(&self) -> Vec<&Line> {
        let mut legend: Vec<&Line> = Vec::new();
        let panels = self.rows.iter().flat_map(|row| &row.panels);
        for line in panels.flat_map(|panel| &panel.lines).filter(|line| !line.name.is_empty()) {
            if legend.iter().all(|known| known.name != line.name) {
                legend.push(line);
            }
        }
        legend.truncate(MAX_NAMES);
        legend
    }

    /// The graphs of a row, which share its width with the labels between them.
    fn graphs<'a>(&self, row: &'a Row) -> Vec<Graph<'a>> {
        let width_of = |margin: f64| (GRAPH_WIDTH - margin) / row.panels.len() as f64;
        let height = GRAPH_HEIGHTS[usize::from(row.panels.len() > 1)];
        let graphs = |width| -> Vec<_> {
            row.panels.iter().map(|panel| panel.graph(self.units, (width, height), row.equal_scales)).collect()
        };
        // The width of tick labels hardly depends on that of the graph.
        let first = graphs(width_of(0.0));
        match first.get(1) {
            Some(second) => graphs(width_of(second.margin())),
            None => first,
        }
    }
}

impl Panel {
    fn graph(&self, units: Units, (width, height): (f64, f64), equal_scales: bool) -> Graph<'_> {
        let points = || self.lines.iter().flat_map(|line| &line.points).filter(|(x, y)| x.is_finite() && y.is_finite());
        let [most_x, most_y] = [width / TICK_DISTANCES[0], height / TICK_DISTANCES[1]];
        let mut x = Scale::of(self.x, units, points().map(|point| point.0), most_x, 0.5);
        // A force or a stiffness is compared with 0.
        let mut y = Scale::of(self.y, units, points().map(|point| point.1), most_y, 1.0);
        if equal_scales {
            Scale::equalise(&mut x, &mut y, width / height);
        }
        Graph { panel: self, x, y, width, height }
    }
}

impl Graph<'_> {
    /// Width of the labels on the left.
    fn margin(&self) -> f64 {
        let ticks = self.y.ticks.iter().map(|tick| text_width(&self.y.tick_label(*tick))).fold(0.0, f64::max);
        PADDING + LINE_HEIGHT + ticks + 2.0 * TICK_LENGTH
    }

    /// Draws the graph, with labels to the left and below.
    fn draw_on(&self, svg: &mut Svg, (left, top): Point) {
        let Graph { panel, x, y, .. } = self;
        let (right, bottom) = (left + self.width, top + self.height);
        let to_x = |place: f64| left + x.fraction(place) * self.width;
        let to_y = |place: f64| bottom - y.fraction(place) * self.height;

        for &tick in &x.ticks {
            svg.lines(&[vec![(to_x(tick), top), (to_x(tick), bottom)]], &GRID);
            svg.lines(&[vec![(to_x(tick), bottom), (to_x(tick), bottom + TICK_LENGTH)]], &AXIS);
            svg.text(&x.tick_label(tick), (to_x(tick), bottom + 15.0), 0.5, false);
        }
        for &tick in &y.ticks {
            svg.lines(&[vec![(left, to_y(tick)), (right, to_y(tick))]], &GRID);
            svg.lines(&[vec![(left - TICK_LENGTH, to_y(tick)), (left, to_y(tick))]], &AXIS);
            svg.text(&y.tick_label(tick), (left - 2.0 * TICK_LENGTH, to_y(tick)), 1.0, false);
        }
        svg.lines(&[vec![(left, top), (left, bottom), (right, bottom)]], &AXIS);
        svg.text(&x.label, (0.5 * (left + right), bottom + 38.0), 0.5, false);
        svg.text(&y.label, (left - self.margin() + PADDING + 8.0, 0.5 * (top + bottom)), 0.5, true);

        for line in &panel.lines {
            let stroke = stroke(line.stroke);
            let to_canvas = |point: &Point| (to_x(x.place(point.0)), to_y(y.place(point.1)));
            let points: Vec<_> = line.points.iter().map(to_canvas).collect();
            let parts = points.split(|point| !(point.0.is_finite() && point.1.is_finite()));
            for part in parts.filter(|part| !part.is_empty()) {
                match &thinned(part, MAX_POINTS / panel.lines.len())[..] {
                    [single] if single.len() == 1 => {
                        let (x, y) = single[0];
                        svg.lines(&[vec![(x - 4.0, y), (x + 4.0, y)]], &Stroke { width: 8.0, dash: None, ..stroke });
                    }
                    lines => svg.lines(lines, &stroke),
                }
            }
        }
    }
}

/// Entries of a legend: as many as there are strokes.
const MAX_NAMES: usize = DASHES.len() * COLOURS.len();

/// Points of the lines of a panel; more could not be distinguished.
const MAX_POINTS: usize = 20_000;

/// The visible parts of a line in pixels: without segments between places of 0.25, 0.5, 1 ... pixels that are the same or already
/// joined, until few enough remain.
fn thinned(points: &[Point], limit: usize) -> Vec<Vec<Point>> {
    let mut place = 0.25;
    loop {
        let at = |point: Point| [point.0, point.1].map(|at| (at / place) as i32);
        let mut drawn = HashSet::new();
        let mut lines = vec![vec![points[0]]];
        for pair in points.windows(2) {
            let [from, to] = [at(pair[0]), at(pair[1])];
            if from == to {
                continue;
            }
            let is_new = drawn.insert([from.min(to), from.max(to)]);
            match lines.last_mut() {
                Some(line) if is_new => line.push(pair[1]),
                Some(line) if line.len() == 1 => line[0] = pair[1],
                _ => lines.push(vec![pair[1]]),
            }
        }
        lines.retain(|line| line.len() > 1);
        if lines.is_empty() {
            return vec![vec![points[0]]];
        }
        if lines.iter().map(Vec::len).sum::<usize>() <= limit.max(2) {
            return lines;
        }
        place *= 2.0;
    }
}

/// A number with its unit, to three digits.
pub fn rounded(value: f64, quantity: Quantity, units: Units) -> String {
    let value = value * units.in_si(quantity);
    let (power, unit) = prefixed(value.abs(), quantity);
    let value = value / 10f64.powi(power);
    let decimals = [9.995, 99.95].iter().filter(|limit| value.abs() < **limit).count();
    format!("{value:.decimals$} {unit}")
}

const PREFIXES: [(i32, &str); 9] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];

/// The power of ten for which a number has one to three digits before the point, and the SI unit with that prefix.
fn prefixed(size: f64, quantity: Quantity) -> (i32, String) {
    // A number has no unit that could have a prefix.
    let thousands = if size > 0.0 && quantity != Quantity::Number { (size.log10() / 3.0).floor() as i32 } else { 0 };
    let power = 3 * thousands.max(-100); // smaller powers would underflow
    let unit = Units::Si.unit(quantity);
    match PREFIXES.iter().find(|(known, _)| *known == power) {
        Some((_, prefix)) => (power, format!("{prefix}{unit}")),
        None => (power, format!("1e{power} {unit}")),
    }
}

/// The scale of an axis. The place of a value is the value in the unit of the label, or its decimal logarithm.
#[derive(Debug)]
struct Scale {
    axis: Axis,
    label: String,
    in_si: f64,
    /// Power of ten of the unit of the label.
    power: i32,
    range: Range<f64>,
    ticks: Vec<f64>,
    /// Digits of the tick labels after the point.
    decimals: usize,
}

impl Scale {
    /// The scale that contains the values, with at most `most` intervals between ticks. A linear one starts at 0 if the least value
    /// is at most the fraction `near` of the largest.
    fn of(axis: Axis, units: Units, values: impl Iterator<Item = f64>, most: f64, near: f64) -> Scale {
        let in_si = units.in_si(axis.quantity);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.map(|value| value * in_si).filter(|value| !axis.logarithmic || *value > 0.0) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (1.0, 1.0);
        }
        let (power, label) = axis.label(low.abs().max(high.abs()));
        let mut scale = Scale { axis, label, in_si, power, range: 0.0..1.0, ticks: Vec::new(), decimals: 0 };
        let (low, high) = (scale.place(low / in_si), scale.place(high / in_si));
        if axis.logarithmic {
            scale.set_powers(low, high, most)
        } else {
            scale.set_steps(low, high, most, near)
        }
        scale
    }

    /// A linear range with a margin.
    fn set_steps(&mut self, low: f64, high: f64, most: f64, near: f64) {
        // For equal values a tenth of them; 1 for 0.
        let least = if high > low {
            0.0
        } else if high == 0.0 {
            1.0
        } else {
            0.1 * high.abs()
        };
        let margin = 0.04 * (high - low) + least;
        let start = if low < 0.0 || low > near * high { low - margin } else { 0.0 };
        self.range = start..high + margin;
        self.set_ticks(most);
    }

    /// Ticks of the range, at most `most` intervals of 1, 2 or 5 times a power of ten.
    fn set_ticks(&mut self, most: f64) {
        let Range { start, end } = self.range;
        let rough = (end - start) / most;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0].into_iter().map(|step| step * power).find(|step| *step >= rough).unwrap_or(10.0 * power);
        let ticks = (start / step).ceil() as i64..=(end / step).floor() as i64;
        self.ticks = ticks.map(|i| i as f64 * step).collect();
        // A step of 0.2 has one digit after the point, even if its logarithm is rounded.
        self.decimals = (-(1.001 * step).log10().floor()).max(0.0) as usize;
    }

    /// Widens one of two linear ranges so that both axes have the same unit, scale and ticks; `aspect` is the width of the graph
    /// over its height.
    fn equalise(x: &mut Scale, y: &mut Scale, aspect: f64) {
        let power = x.power.max(y.power);
        for scale in [&mut *x, &mut *y] {
            let factor = 10f64.powi(scale.power - power);
            scale.range = factor * scale.range.start..factor * scale.range.end;
            (scale.power, scale.label) = scale.axis.label(2.0 * 10f64.powi(power));
        }
        let length = |scale: &Scale| scale.range.end - scale.range.start;
        let height = length(y).max(length(x) / aspect);
        for (scale, wanted) in [(&mut *x, aspect * height), (&mut *y, height)] {
            let margin = 0.5 * (wanted - length(scale));
            scale.range = scale.range.start - margin..scale.range.end + margin;
            // Five intervals in height: the same distance along both axes.
            scale.set_ticks(5.0 * length(scale) / height);
        }
    }

    /// A logarithmic range with at least two powers of ten.
    fn set_powers(&mut self, low: f64, high: f64, most: f64) {
        let (low, high) = if high - low < 2.0 { ((low - 1e-9).floor(), (high + 1e-9).ceil()) } else { (low, high) };
        let every = ((high - low) / most).ceil() as usize;
        self.ticks = (low.ceil() as i32..=high.floor() as i32).step_by(every).map(f64::from).collect();
        self.range = low..high;
    }

    fn place(&self, value: f64) -> f64 {
        let value = value * self.in_si;
        if self.axis.logarithmic { value.log10() - f64::from(self.power) } else { value / 10f64.powi(self.power) }
    }

    /// Fraction of the range up to a place.
    fn fraction(&self, place: f64) -> f64 {
        (place - self.range.start) / (self.range.end - self.range.start)
    }

    fn tick_label(&self, place: f64) -> String {
        if self.axis.logarithmic {
            format_number(10f64.powi(place.round() as i32))
        } else {
            format!("{:.*}", self.decimals, place + 0.0) // without the sign of -0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::canvas::parsed;
    use resvg::usvg::Node;

    #[test]
    fn texts_lie_inside_the_picture_and_apart() {
        let line = |stroke, name: &str, size: f64| Line {
            stroke,
            name: name.to_owned(),
            points: (0..9).map(|i| (f64::from(i) * 1e-7, size * (f64::from(i) - 1.5))).collect(),
        };
        let panel = |size| Panel {
            x: Axis::linear("displacement", Quantity::Length),
            y: Axis::linear("magnitude of the tangential force", Quantity::Force),
            lines: vec![line(0, "measured", size), line(1, "a name of a line that is longer than others", size)],
        };
        let numbers = Axis::linear("misfit over the least", Quantity::Number);
        let mut tall = Panel { y: numbers, ..panel(1.0) };
        tall.lines.extend((0..40).map(|i| line(i, &format!("line {i}"), 2e7)));
        let rows = vec![
            Row { panels: vec![panel(1.0), panel(0.999)], equal_scales: false },
            Row { panels: vec![panel(3e-3), panel(2e9)], equal_scales: true },
            panel(1.0).into(),
            tall.into(),
        ];
        for rows in [rows, vec![panel(1e-9).into()]] {
            let caption = "N = 150 N, ".repeat(12);
            let picture = Picture { caption, units: Units::Si, rows };
            let drawn = parsed(&picture.draw()).unwrap();
            let texts = drawn.root().children().iter().filter_map(|node| match node {
                Node::Group(group) => match &group.children()[0] {
                    Node::Text(text) => Some((text.abs_bounding_box(), text.chunks()[0].text())),
                    _ => None,
                },
                _ => None,
            });
            let texts: Vec<_> = texts.collect();
            assert!(texts.len() > 10);
            for (i, (one, text)) in texts.iter().enumerate() {
                let (width, height) = (drawn.size().width(), drawn.size().height());
                let is_inside = one.left() >= 0.0 && one.right() <= width && one.top() >= 0.0 && one.bottom() <= height;
                assert!(is_inside, "{text}: {one:?}");
                for (other, other_text) in &texts[..i] {
                    assert!(one.intersect(other).is_none(), "{text} covers {other_text}: {one:?} {other:?}");
                }
            }
        }
    }
}
