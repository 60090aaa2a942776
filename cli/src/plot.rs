//! Pictures: orbits side by side, panels one below the other, axes with units, and lines that differ in dashes and in colour.

use crate::canvas::{Bitmap, Canvas, Format, Point, Stroke, Svg};
use crate::number::format_number;
use crate::units::{Quantity, Units};
use std::ops::Range;

#[derive(Debug)]
pub struct Picture {
    /// Parameters of the contact.
    pub caption: String,
    pub units: Units,
    /// Panels side by side whose axes have the same scale.
    pub orbits: Option<[Panel; 2]>,
    pub panels: Vec<Panel>,
}

#[derive(Debug)]
pub struct Panel {
    pub x: Axis,
    pub y: Axis,
    pub lines: Vec<Line>,
}

#[derive(Debug, Clone, Copy)]
pub struct Axis {
    pub name: &'static str,
    pub quantity: Quantity,
    pub logarithmic: bool,
}

#[derive(Debug)]
pub struct Line {
    /// Entry of the legend; empty if the line is the only one.
    pub name: String,
    pub points: Vec<Point>,
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
        (power, format!("{} [{unit}]", self.name))
    }
}

const WIDTH: u32 = 860;
const PANEL_HEIGHT: u32 = 400;
const CAPTION_HEIGHT: u32 = 36;
/// Of a legend, at least and at most; of its lines, and of a letter.
const LEGEND_WIDTHS: [f64; 2] = [190.0, 340.0];
const KEY_WIDTH: f64 = 46.0;
const LETTER_WIDTH: f64 = 8.4;
/// Of the graph in its panel: left, right, top, bottom.
const MARGINS: [f64; 4] = [94.0, 24.0, 8.0, 54.0];
const TICK_LENGTH: f64 = 4.0;

/// Dashes and colours of the lines of a panel, lighter from line to line: they also differ in grey. The next four lines are thin.
const STROKES: [(Option<[f32; 2]>, [u8; 3]); 4] = [
    (None, [0, 0, 0]),
    (Some([14.0, 6.0]), [0, 90, 180]),
    (Some([5.0, 4.0]), [200, 70, 0]),
    (Some([2.0, 4.0]), [0, 140, 100]),
];
const AXIS: Stroke = Stroke { colour: [0, 0, 0], width: 1.0, dash: None };
const GRID: Stroke = Stroke { colour: [214, 214, 214], width: 1.0, dash: None };

impl Picture {
    /// The contents of the file.
    pub fn draw(&self, format: Format) -> Result<Vec<u8>, &'static str> {
        let rows = self.panels.len() + usize::from(self.orbits.is_some());
        let size = (WIDTH, CAPTION_HEIGHT + PANEL_HEIGHT * rows as u32);
        match format {
            Format::Svg => {
                let mut svg = Svg::new(size);
                self.draw_on(&mut svg);
                Ok(svg.finish())
            }
            Format::Png => {
                let mut bitmap = Bitmap::new(size).ok_or("the bitmap cannot be created")?;
                self.draw_on(&mut bitmap);
                bitmap.finish().ok_or("the bitmap cannot be encoded")
            }
        }
    }

    fn draw_on(&self, canvas: &mut dyn Canvas) {
        canvas.text(&self.caption, (24.0, 20.0), 0.0, false);
        let names = self.panels.iter().filter(|panel| panel.lines.len() > 1).flat_map(|panel| &panel.lines);
        let letters = names.map(|line| line.name.chars().count()).max();
        let [least, most] = LEGEND_WIDTHS;
        let right = letters.map_or(MARGINS[1], |count| (KEY_WIDTH + LETTER_WIDTH * count as f64).clamp(least, most));
        let mut top = f64::from(CAPTION_HEIGHT);
        let end = f64::from(WIDTH);
        if let Some([first, second]) = &self.orbits {
            first.draw_on(canvas, Area { left: 0.0, right: 0.5 * end - MARGINS[1], top, equal: true }, self.units);
            second.draw_on(canvas, Area { left: 0.5 * end, right: end - MARGINS[1], top, equal: true }, self.units);
            top += f64::from(PANEL_HEIGHT);
        }
        for panel in &self.panels {
            panel.draw_on(canvas, Area { left: 0.0, right: end - right, top, equal: false }, self.units);
            top += f64::from(PANEL_HEIGHT);
        }
    }
}

/// Where a panel is drawn: from the left edge of its labels to the right end of its x axis, and below `top`.
struct Area {
    left: f64,
    right: f64,
    top: f64,
    /// Whether both axes have the same scale.
    equal: bool,
}

impl Panel {
    fn draw_on(&self, canvas: &mut dyn Canvas, area: Area, units: Units) {
        let points = || self.lines.iter().flat_map(|line| &line.points);
        let Area { left: edge, right, top, equal } = area;
        let bottom = top + f64::from(PANEL_HEIGHT) - MARGINS[3];
        let (left, top) = (edge + MARGINS[0], top + MARGINS[2]);
        let mut x = Scale::of(self.x, units, points().map(|point| point.0));
        let mut y = Scale::of(self.y, units, points().map(|point| point.1));
        if equal {
            Scale::equalise(&mut x, &mut y, (right - left) / (bottom - top));
        }
        let to_x = |place: f64| left + x.fraction(place) * (right - left);
        let to_y = |place: f64| bottom - y.fraction(place) * (bottom - top);

        for &tick in &x.ticks {
            canvas.lines(&[vec![(to_x(tick), top), (to_x(tick), bottom)]], &GRID);
            canvas.lines(&[vec![(to_x(tick), bottom), (to_x(tick), bottom + TICK_LENGTH)]], &AXIS);
            canvas.text(&x.tick_label(tick), (to_x(tick), bottom + 15.0), 0.5, false);
        }
        for &tick in &y.ticks {
            canvas.lines(&[vec![(left, to_y(tick)), (right, to_y(tick))]], &GRID);
            canvas.lines(&[vec![(left - TICK_LENGTH, to_y(tick)), (left, to_y(tick))]], &AXIS);
            canvas.text(&y.tick_label(tick), (left - 8.0, to_y(tick)), 1.0, false);
        }
        canvas.lines(&[vec![(left, top), (left, bottom), (right, bottom)]], &AXIS);
        canvas.text(&x.label, (0.5 * (left + right), bottom + 38.0), 0.5, false);
        canvas.text(&y.label, (edge + 20.0, 0.5 * (top + bottom)), 0.5, true);

        for (i, line) in self.lines.iter().enumerate() {
            let (dash, colour) = STROKES[i % STROKES.len()];
            let width = if (i / STROKES.len()).is_multiple_of(2) { 2.0 } else { 1.0 };
            let stroke = Stroke { colour, width, dash };
            let to_canvas = |point: &Point| (to_x(x.place(point.0)), to_y(y.place(point.1)));
            let points = line.points.iter().map(to_canvas).filter(|point| point.0.is_finite() && point.1.is_finite());
            match &thinned(points.collect(), MAX_POINTS / self.lines.len())[..] {
                [single] if single.len() == 1 => {
                    let (x, y) = single[0];
                    canvas.lines(&[vec![(x - 4.0, y), (x + 4.0, y)]], &Stroke { width: 8.0, dash: None, ..stroke });
                }
                lines => canvas.lines(lines, &stroke),
            }
            let (start, row) = (right + 4.0, top + 16.0 + 24.0 * i as f64);
            if self.lines.len() > 1 && row < bottom {
                canvas.lines(&[vec![(start, row), (start + 34.0, row)]], &stroke);
                canvas.text(&line.name, (start + 42.0, row), 0.0, false);
            }
        }
    }
}

/// Points of the lines of a panel; more could not be distinguished.
const MAX_POINTS: usize = 40_000;

/// The visible parts of a line in pixels. Points closer than a quarter of a pixel to the one before are dropped. If too many
/// remain, so are the segments that enter no new cell, of 1, 2, 4 ... pixels: the number of cells bounds that of segments.
fn thinned(mut points: Vec<Point>, limit: usize) -> Vec<Vec<Point>> {
    let length = |from: &Point, to: &Point| (to.0 - from.0).hypot(to.1 - from.1);
    let last = points.last().copied();
    points.dedup_by(|next, kept| length(kept, next) < 0.25);
    if let Some((end, last)) = points.last_mut().zip(last) {
        *end = last;
    }
    let height = points.iter().fold(0.0, |height: f64, point| height.max(point.1)) as usize + 1;
    let mut lines = vec![points.clone()];
    let mut cell = 1.0;
    while lines.iter().map(Vec::len).sum::<usize>() > limit.max(2) && cell < f64::from(WIDTH) {
        let (mut drawn, mut gap) = (vec![false; WIDTH as usize * height], f64::INFINITY);
        lines.clear();
        for pair in points.windows(2) {
            let [from, to] = [pair[0], pair[1]];
            let steps = (length(&from, &to) / cell).ceil().max(1.0);
            let mut enters = false;
            for part in (0..=steps as u32).map(|i| f64::from(i) / steps) {
                let [x, y] = [from.0 + part * (to.0 - from.0), from.1 + part * (to.1 - from.1)];
                let index = (y / cell) as usize * WIDTH as usize + (x / cell) as usize;
                enters |= !std::mem::replace(&mut drawn[index], true);
            }
            match lines.last_mut() {
                _ if !enters => gap += length(&from, &to),
                // Short gaps are bridged.
                Some(line) if gap <= 2.0 * cell => line.extend(if gap > 0.0 { vec![from, to] } else { vec![to] }),
                _ => lines.push(vec![from, to]),
            }
            gap = if enters { 0.0 } else { gap };
        }
        cell *= 2.0;
    }
    lines
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
    logarithmic: bool,
    in_si: f64,
    /// Power of ten of the unit of the label.
    power: i32,
    range: Range<f64>,
    ticks: Vec<f64>,
    /// Digits of the tick labels after the point.
    decimals: usize,
}

impl Scale {
    fn of(axis: Axis, units: Units, values: impl Iterator<Item = f64>) -> Scale {
        let in_si = units.in_si(axis.quantity);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.map(|value| value * in_si).filter(|value| !axis.logarithmic || *value > 0.0) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (1.0, 1.0);
        }
        let (power, label) = axis.label(low.abs().max(high.abs()));
        let mut scale = Scale {
            axis,
            label,
            logarithmic: axis.logarithmic,
            in_si,
            power,
            range: 0.0..1.0,
            ticks: Vec::new(),
            decimals: 0,
        };
        let (low, high) = (scale.place(low / in_si), scale.place(high / in_si));
        if axis.logarithmic {
            scale.set_powers(low, high)
        } else {
            scale.set_steps(low, high)
        }
        scale
    }

    /// A linear range with a margin; it starts at 0 if that is close.
    fn set_steps(&mut self, low: f64, high: f64) {
        // For equal values a tenth of them; 1 for 0.
        let least = if high > low {
            0.0
        } else if high == 0.0 {
            1.0
        } else {
            0.1 * high.abs()
        };
        let margin = 0.04 * (high - low) + least;
        let start = if low < 0.0 || low > 0.5 * high { low - margin } else { 0.0 };
        self.range = start..high + margin;
        // Four to eleven ticks.
        self.set_ticks(0.1 * (self.range.end - self.range.start));
    }

    /// Ticks of the range with this distance at least: 1, 2 or 5 times a power of ten.
    fn set_ticks(&mut self, rough: f64) {
        let Range { start, end } = self.range;
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
            scale.set_ticks(height / 7.0);
        }
    }

    /// A logarithmic range with at least two powers of ten.
    fn set_powers(&mut self, low: f64, high: f64) {
        let (low, high) = if high - low < 2.0 { ((low - 1e-9).floor(), (high + 1e-9).ceil()) } else { (low, high) };
        let every = ((high - low) / 8.0).ceil() as usize;
        self.ticks = (low.ceil() as i32..=high.floor() as i32).step_by(every).map(f64::from).collect();
        self.range = low..high;
    }

    fn place(&self, value: f64) -> f64 {
        let value = value * self.in_si;
        if self.logarithmic { value.log10() - f64::from(self.power) } else { value / 10f64.powi(self.power) }
    }

    /// Fraction of the range up to a place.
    fn fraction(&self, place: f64) -> f64 {
        (place - self.range.start) / (self.range.end - self.range.start)
    }

    fn tick_label(&self, place: f64) -> String {
        if self.logarithmic {
            format_number(10f64.powi(place.round() as i32))
        } else {
            format!("{:.*}", self.decimals, place + 0.0) // without the sign of -0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn picture(x: Axis, points: &[Point]) -> Picture {
        let lines = vec![Line { name: String::new(), points: points.to_vec() }];
        let panels = vec![Panel { x, y: Axis::linear("force", Quantity::Force), lines }];
        Picture { caption: String::new(), units: Units::Si, orbits: None, panels }
    }

    #[test]
    fn every_axis_has_ticks_and_contains_its_values() {
        let sizes = [-1e150, -3.0, -1e-9, 0.0, 1e-300, 2.5e-7, 0.999, 1.0, 1.0 + f64::EPSILON, 1234.5, 1e150];
        for (i, low) in sizes.into_iter().enumerate() {
            for (high, logarithmic) in sizes.into_iter().skip(i).flat_map(|high| [(high, false), (high, true)]) {
                let axis = Axis { name: "x", quantity: Quantity::Length, logarithmic };
                let scale = Scale::of(axis, Units::Mm, [low, high].into_iter());
                assert!((2..=11).contains(&scale.ticks.len()), "{low} {high} {scale:?}");
                for value in [low, high].into_iter().filter(|value| !logarithmic || *value > 0.0) {
                    assert!((0.0..=1.0).contains(&scale.fraction(scale.place(value))), "{low} {high} {scale:?}");
                }
            }
        }
    }

    #[test]
    fn labels_have_suitable_units_and_digits() {
        let scale = |axis, units, values: [f64; 2]| Scale::of(axis, units, values.into_iter());
        for (largest, quantity, label) in [
            (2.5e-3, Quantity::Length, " [µm]"),
            (1500.0, Quantity::Pressure, " [GPa]"),
            (700.0, Quantity::Stiffness, " [kN/m]"),
        ] {
            assert_eq!(scale(Axis::linear("", quantity), Units::Mm, [0.0, largest]).label, label);
        }
        for (value, quantity, units, text) in [
            (0.9999, Quantity::Length, Units::Mm, "1000 µm"),
            (-12.34, Quantity::Force, Units::Si, "-12.3 N"),
            (0.0, Quantity::Energy, Units::Si, "0.00 J"),
            (1e30, Quantity::Force, Units::Si, "1.00 1e30 N"),
        ] {
            assert_eq!(rounded(value, quantity, units), text);
        }
        for (axis, values, labels) in [
            (Axis::linear("", Quantity::Force), [-1.0, 1.0], ["-1.0", "-0.5", "0.0", "0.5", "1.0"]),
            (Axis::logarithmic("", Quantity::Force), [1e-3, 20.0], ["1e-3", "0.01", "0.1", "1", "10"]),
        ] {
            let scale = scale(axis, Units::Si, values);
            assert_eq!(scale.ticks.iter().map(|tick| scale.tick_label(*tick)).collect::<Vec<_>>(), labels);
        }
    }

    #[test]
    fn the_amplitude_0_is_not_drawn_on_a_logarithmic_axis() {
        let svg =
            |points: &[Point]| picture(Axis::logarithmic("", Quantity::Length), points).draw(Format::Svg).unwrap();
        let points = [(0.0, 2.0), (1.0, 3.0), (10.0, 1.0)];
        assert_eq!(svg(&points), svg(&points[1..]));
        assert_ne!(svg(&points), svg(&[(0.5, 2.0), (1.0, 3.0), (10.0, 1.0)]));
    }

    /// Dark pixels of polylines.
    fn ink(lines: &[Vec<Point>]) -> Vec<bool> {
        let mut bitmap = Bitmap::new((600, 400)).unwrap();
        bitmap.lines(lines, &Stroke { width: 2.0, ..AXIS });
        bitmap.pixels().chunks(4).map(|pixel| pixel[0] < 128).collect()
    }

    #[test]
    fn long_lines_are_thinned_without_a_visible_change() {
        let ellipse = |size_x: f64, size_y: f64, turns: f64| {
            let angle = turns * std::f64::consts::TAU;
            (300.0 + 200.0 * size_x * angle.cos(), 200.0 + 150.0 * size_y * angle.sin())
        };
        let random = |t: f64, k: f64| (4e4 * (1e5 * k * t).sin()).rem_euclid(1.0);
        let histories: [(&str, &dyn Fn(f64) -> Point); 3] = [
            ("many cycles", &|t| ellipse(1.0, 1.0, 39.7 * t)),
            ("cycles of growing amplitude", &|t| ellipse(t, t, 12.0 * t)),
            ("random", &|t| ellipse(2.0 * random(t, 1.1) - 1.0, 2.0 * random(t, 7.3) - 1.0, 0.125)),
        ];
        for (name, point) in histories {
            let points: Vec<_> = (0..8_000).map(|i| point(f64::from(i) / 8e3)).collect();
            let lines = thinned(points.clone(), 4_000);
            let count = lines.iter().map(Vec::len).sum::<usize>();
            let (all, thinned) = (ink(&[points]), ink(&lines));
            let [changed, total] = [
                all.iter().zip(&thinned).filter(|(all, thinned)| all != thinned).count(),
                all.iter().filter(|all| **all).count(),
            ];
            assert!(count <= 4_000 && changed * 50 <= total, "{name}: {changed} of {total} pixels, {count} points");
        }
    }
}
