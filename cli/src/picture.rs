//! Pictures: panels one below the other, axes with units, lines that differ in dashes as well as in colour.

use crate::digits::digits;
use crate::units::{Quantity, Units};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::element::DashedPathElement;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{FontStyle, register_font};
use std::error::Error;
use std::ops::Range;

#[derive(Debug)]
pub struct Picture {
    /// What contact it is.
    pub caption: String,
    pub units: Units,
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
    /// In the legend; none where it is empty.
    pub name: String,
    pub points: Vec<(f64, f64)>,
}

impl Axis {
    pub const fn linear(name: &'static str, quantity: Quantity) -> Axis {
        Axis { name, quantity, logarithmic: false }
    }

    pub const fn logarithmic(name: &'static str, quantity: Quantity) -> Axis {
        Axis { name, quantity, logarithmic: true }
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Format {
    Svg,
    Png,
}

const WIDTH: u32 = 860;
const PANEL_HEIGHT: u32 = 400;
const CAPTION_HEIGHT: u32 = 36;
const LEGEND_WIDTH: u32 = 190;

/// Pixels of a bitmap are means over squares of so many: what is drawn has no smooth edges of its own.
const OVERSAMPLING: u32 = 3;
/// Pixels of a bitmap for one of the sizes above.
const RESOLUTION: u32 = 2;

/// Vectors are drawn in whole numbers, so many for one of the sizes above.
const SUBDIVISION: u32 = 8;

type DrawingResult = Result<(), Box<dyn Error>>;

impl Picture {
    /// The picture as the contents of a file.
    ///
    /// # Errors
    /// None are expected: it is drawn to memory.
    pub fn draw(&self, format: Format) -> Result<Vec<u8>, Box<dyn Error>> {
        // Known to every process once; a second time does nothing.
        register_font("sans-serif", FontStyle::Normal, dejavu::sans::regular())
            .map_err(|_| "the font of the pictures cannot be read")?;
        let height = CAPTION_HEIGHT + PANEL_HEIGHT * self.panels.len() as u32;
        match format {
            Format::Svg => {
                let fine = (WIDTH * SUBDIVISION, height * SUBDIVISION);
                let mut text = String::new();
                self.draw_on(&SVGBackend::with_string(&mut text, fine).into_drawing_area(), SUBDIVISION)?;
                let size = |(width, height): (u32, u32)| format!("width=\"{width}\" height=\"{height}\"");
                Ok(text.replacen(&size(fine), &size((WIDTH, height)), 1).into_bytes())
            }
            Format::Png => {
                let size = (WIDTH * RESOLUTION, height * RESOLUTION);
                let fine = (size.0 * OVERSAMPLING, size.1 * OVERSAMPLING);
                let mut pixels = vec![0; 3 * (fine.0 * fine.1) as usize];
                let area = BitMapBackend::with_buffer(&mut pixels, fine).into_drawing_area();
                self.draw_on(&area, RESOLUTION * OVERSAMPLING)?;
                drop(area);
                png(size, &means(&pixels, size))
            }
        }
    }

    fn draw_on<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>, scale: u32) -> DrawingResult
    where
        B::ErrorType: 'static,
    {
        area.fill(&WHITE)?;
        let (top, panels) = area.split_vertically(CAPTION_HEIGHT * scale);
        let font = ("sans-serif", 14 * scale).into_font().color(&BLACK.mix(0.7));
        top.draw(&Text::new(self.caption.as_str(), ((24 * scale) as i32, (14 * scale) as i32), font))?;
        let has_legend = self.panels.iter().any(|panel| panel.lines.len() > 1);
        for (panel, area) in self.panels.iter().zip(panels.split_evenly((self.panels.len().max(1), 1))) {
            panel.draw_on(&area, self.units, has_legend, scale)?;
        }
        area.present()?;
        Ok(())
    }
}

/// Strokes in the order of the lines: dash and gap in pixels (none: a whole line), and colour. Colours grow lighter, so that
/// they also differ in grey. The next as many lines have the same, but thin.
const STROKES: [(Option<(u32, u32)>, RGBColor); 4] = [
    (None, RGBColor(0, 0, 0)),
    (Some((14, 6)), RGBColor(0, 90, 180)),
    (Some((5, 4)), RGBColor(200, 70, 0)),
    (Some((2, 4)), RGBColor(0, 140, 100)),
];

impl Panel {
    fn draw_on<B: DrawingBackend>(
        &self,
        area: &DrawingArea<B, Shift>,
        units: Units,
        has_legend: bool,
        scale: u32,
    ) -> DrawingResult
    where
        B::ErrorType: 'static,
    {
        let x = Scale::of(self.x, units, self.lines.iter().flat_map(|line| &line.points).map(|point| point.0));
        let y = Scale::of(self.y, units, self.lines.iter().flat_map(|line| &line.points).map(|point| point.1));
        let (graph, legend) = area.split_horizontally((WIDTH - if has_legend { LEGEND_WIDTH } else { 24 }) * scale);
        let mut chart = ChartBuilder::on(&graph)
            .margin_top(8 * scale)
            .margin_bottom(8 * scale)
            .margin_left(10 * scale)
            .x_label_area_size(46 * scale)
            .y_label_area_size(84 * scale)
            .build_cartesian_2d(x.clone(), y.clone())?;
        let font = ("sans-serif", 14 * scale);
        chart
            .configure_mesh()
            .bold_line_style(BLACK.mix(0.16).stroke_width(scale))
            .light_line_style(TRANSPARENT)
            .axis_style(BLACK.stroke_width(scale))
            .set_all_tick_mark_size(4 * scale)
            .label_style(font)
            .axis_desc_style(("sans-serif", 16 * scale))
            .x_desc(x.label.as_str())
            .y_desc(y.label.as_str())
            .x_label_formatter(&|value| x.tick(*value))
            .y_label_formatter(&|value| y.tick(*value))
            .draw()?;
        for (i, line) in self.lines.iter().enumerate() {
            let (dash, colour) = STROKES[i % STROKES.len()];
            let thick = (i / STROKES.len()).is_multiple_of(2);
            let style = colour.stroke_width(if thick { 2 * scale } else { scale });
            let points: Vec<_> =
                line.points.iter().map(|point| (x.place(point.0), y.place(point.1))).filter(is_finite).collect();
            let row = ((scale * 4) as i32, (scale * (24 + 24 * i as u32)) as i32);
            let sample = [row, (row.0 + (34 * scale) as i32, row.1)];
            if let [point] = points[..] {
                chart.draw_series([Circle::new(point, 4 * scale, colour.filled())])?;
            } else if let Some((dash, gap)) = dash {
                chart.draw_series(DashedLineSeries::new(points, dash * scale, gap * scale, style))?;
            } else {
                for run in runs(&points) {
                    chart.draw_series(LineSeries::new(run.iter().copied(), style))?;
                }
            }
            if self.lines.len() > 1 {
                match dash {
                    Some((dash, gap)) => {
                        legend.draw(&DashedPathElement::new(sample, dash * scale, gap * scale, style))?;
                    }
                    None => legend.draw(&PathElement::new(sample, style))?,
                }
                let place = (row.0 + (42 * scale) as i32, row.1);
                let style = font.into_font().color(&BLACK).pos(Pos::new(HPos::Left, VPos::Center));
                legend.draw(&Text::new(line.name.as_str(), place, style))?;
            }
        }
        Ok(())
    }
}

/// The pieces of a line between the points where it turns back: a bitmap leaves out what a piece crosses of itself.
fn runs(points: &[(f64, f64)]) -> Vec<&[(f64, f64)]> {
    let (mut runs, mut start, mut direction) = (Vec::new(), 0, 0.0);
    for (i, pair) in points.windows(2).enumerate() {
        let step = pair[1].0 - pair[0].0;
        if step * direction < 0.0 {
            runs.push(&points[start..=i]);
            start = i;
        }
        if step != 0.0 {
            direction = step.signum();
        }
    }
    runs.push(&points[start..]);
    runs
}

fn is_finite(point: &(f64, f64)) -> bool {
    point.0.is_finite() && point.1.is_finite()
}

/// A number with its unit, in three digits.
pub fn rounded(value: f64, quantity: Quantity, units: Units) -> String {
    let value = value * units.in_si(quantity);
    let (power, unit) = prefixed(value.abs(), quantity);
    let value = value / 10f64.powi(power);
    let decimals = [9.995, 99.95].iter().filter(|limit| value.abs() < **limit).count();
    format!("{value:.decimals$} {unit}")
}

const PREFIXES: [(i32, &str); 9] =
    [(-12, "p"), (-9, "n"), (-6, "µ"), (-3, "m"), (0, ""), (3, "k"), (6, "M"), (9, "G"), (12, "T")];

/// The power of ten, and the name of the unit with it, in which a number has one to three digits before the point.
fn prefixed(size: f64, quantity: Quantity) -> (i32, String) {
    let thousands = if size > 0.0 { (size.log10() / 3.0).floor() as i32 } else { 0 };
    let power = 3 * thousands.max(-100); // smaller ones would underflow
    let unit = Units::Si.unit(quantity);
    match PREFIXES.iter().find(|(known, _)| *known == power) {
        Some((_, prefix)) => (power, format!("{prefix}{unit}")),
        None => (power, format!("1e{power} {unit}")),
    }
}

/// How the numbers of an axis become places on it, and where its ticks are.
#[derive(Debug, Clone)]
struct Scale {
    label: String,
    logarithmic: bool,
    in_si: f64,
    /// Of ten, in the unit of the label.
    power: i32,
    range: Range<f64>,
    ticks: Vec<f64>,
    /// Digits after the point.
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
        let (power, unit) = prefixed(low.abs().max(high.abs()), axis.quantity);
        let mut scale = Scale {
            label: format!("{} [{unit}]", axis.name),
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

    /// From the lowest to the highest place and a little further, from 0 where that is near.
    fn set_steps(&mut self, low: f64, high: f64) {
        // Where all are equal, a tenth of their size; 1 where they are 0.
        let least = if high > low {
            0.0
        } else if high == 0.0 {
            1.0
        } else {
            0.1 * high.abs()
        };
        let margin = 0.04 * (high - low) + least;
        let start = if low < 0.0 || low > 0.5 * high { low - margin } else { 0.0 };
        let end = high + margin;
        // Four to eleven ticks, 1, 2 or 5 times a power of ten apart.
        let rough = (end - start) / 10.0;
        let power = 10f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0].into_iter().map(|step| step * power).find(|step| *step >= rough).unwrap_or(10.0 * power);
        let ticks = (start / step).ceil() as i64..=(end / step).floor() as i64;
        self.ticks = ticks.map(|i| i as f64 * step).collect();
        self.range = start..end;
        // A step of 0.2 has one digit after the point, also where its logarithm is rounded.
        self.decimals = (-(1.001 * step).log10().floor()).max(0.0) as usize;
    }

    /// Powers of ten, at least two of them.
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

    fn tick(&self, place: f64) -> String {
        if self.logarithmic {
            digits(10f64.powi(place.round() as i32))
        } else {
            format!("{:.*}", self.decimals, place + 0.0) // no -0
        }
    }
}

impl Ranged for Scale {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, place: &f64, limit: (i32, i32)) -> i32 {
        let Range { start, end } = self.range;
        limit.0 + ((place - start) / (end - start) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.ticks.clone()
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

/// Means over the squares of a finer picture.
fn means(pixels: &[u8], (width, height): (u32, u32)) -> Vec<u8> {
    let (side, row) = (OVERSAMPLING as usize, 3 * (width * OVERSAMPLING) as usize);
    let mut coarse = Vec::with_capacity(3 * (width * height) as usize);
    for y in 0..height as usize {
        for x in 0..width as usize {
            for colour in 0..3 {
                let start = y * side * row + 3 * x * side + colour;
                let sum: usize = (0..side)
                    .flat_map(|down| (0..side).map(move |right| start + down * row + 3 * right))
                    .map(|place| usize::from(pixels[place]))
                    .sum();
                coarse.push((sum / (side * side)) as u8);
            }
        }
    }
    coarse
}

fn png((width, height): (u32, u32), pixels: &[u8]) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(pixels)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_axis_has_ticks_that_can_be_read() {
        let sizes = [-1e150, -3.0, -1e-9, 0.0, 1e-300, 2.5e-7, 0.999, 1.0, 1.0 + f64::EPSILON, 1234.5, 1e150];
        for (i, low) in sizes.into_iter().enumerate() {
            for high in sizes.into_iter().skip(i) {
                for logarithmic in [false, true] {
                    let axis = Axis { name: "x", quantity: Quantity::Length, logarithmic };
                    let scale = Scale::of(axis, Units::Mm, [low, high].into_iter());
                    assert!(scale.range.start < scale.range.end, "{low} {high} {scale:?}");
                    assert!((2..=11).contains(&scale.ticks.len()), "{low} {high} {scale:?}");
                    for value in [low, high].into_iter().filter(|value| !logarithmic || *value > 0.0) {
                        let place = scale.place(value);
                        assert!(scale.range.start <= place && place <= scale.range.end, "{low} {high} {scale:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn labels_are_in_the_unit_that_suits() {
        let label =
            |largest: f64, quantity| Scale::of(Axis::linear("", quantity), Units::Mm, [0.0, largest].into_iter()).label;
        assert_eq!(label(2.5e-3, Quantity::Length), " [µm]");
        assert_eq!(label(1500.0, Quantity::Pressure), " [GPa]");
        assert_eq!(label(700.0, Quantity::Stiffness), " [kN/m]");
        assert_eq!(rounded(0.9999, Quantity::Length, Units::Mm), "1000 µm");
        assert_eq!(rounded(-12.34, Quantity::Force, Units::Si), "-12.3 N");
        assert_eq!(rounded(0.0, Quantity::Energy, Units::Si), "0.00 J");
        assert_eq!(rounded(1e30, Quantity::Force, Units::Si), "1.00 1e30 N");
    }

    #[test]
    fn ticks_have_the_digits_they_need() {
        let scale = Scale::of(Axis::linear("", Quantity::Force), Units::Si, [-1.0, 1.0].into_iter());
        let ticks: Vec<_> = scale.ticks.iter().map(|tick| scale.tick(*tick)).collect();
        assert_eq!(ticks, ["-1.0", "-0.5", "0.0", "0.5", "1.0"]);
        let scale = Scale::of(Axis::logarithmic("", Quantity::Force), Units::Si, [1e-3, 20.0].into_iter());
        let ticks: Vec<_> = scale.ticks.iter().map(|tick| scale.tick(*tick)).collect();
        assert_eq!(ticks, ["1e-3", "0.01", "0.1", "1", "10"]);
    }

    #[test]
    fn a_line_is_cut_where_it_turns_back() {
        let points = [(0.0, 0.0), (1.0, 1.0), (1.0, 2.0), (0.5, 0.0), (0.7, 0.0)];
        assert_eq!(runs(&points), [&points[..3], &points[2..4], &points[3..]]);
        assert_eq!(runs(&points[..0]), [&points[..0]]);
    }

    #[test]
    fn the_amplitude_0_has_no_place_on_a_logarithmic_axis() {
        let picture = |points: &[(f64, f64)]| {
            let lines = vec![Line { name: String::new(), points: points.to_vec() }];
            let x = Axis::logarithmic("amplitude", Quantity::Length);
            let panels = vec![Panel { x, y: Axis::linear("stiffness", Quantity::Stiffness), lines }];
            Picture { caption: String::new(), units: Units::Si, panels }.draw(Format::Svg).unwrap()
        };
        let points = [(0.0, 2.0), (1.0, 3.0), (10.0, 1.0)];
        assert_eq!(picture(&points), picture(&points[1..]));
        assert_ne!(picture(&points), picture(&[(0.5, 2.0), (1.0, 3.0), (10.0, 1.0)]));
    }

    #[test]
    fn a_bitmap_is_the_mean_of_a_finer_one() {
        let side = OVERSAMPLING as usize;
        let mut fine = vec![0; 3 * 2 * side * side];
        fine[3 * (side + 1) + 1] = 255; // one green pixel of the second square
        assert_eq!(means(&fine, (2, 1)), [0, 0, 0, 0, (255 / (side * side)) as u8, 0]);
    }
}
