//! Drawing of lines and text into SVG and PNG files.

use std::fmt::Write;
use tiny_skia::{Color, FillRule, LineCap, LineJoin, Paint, PathBuilder, Pixmap, StrokeDash, Transform};
use ttf_parser::{Face, OutlineBuilder};

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Format {
    Svg,
    Png,
}

pub type Point = (f64, f64);

#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    pub colour: [u8; 3],
    pub width: f32,
    /// Lengths of dash and gap.
    pub dash: Option<[f32; 2]>,
}

/// A drawing area; y points downwards from the upper edge.
pub trait Canvas {
    /// Draws polylines of one stroke.
    fn lines(&mut self, lines: &[Vec<Point>], stroke: &Stroke);
    /// Draws black text, vertically centred at the point, with the fraction `before` of its width before it. Rotated text
    /// runs upwards.
    fn text(&mut self, text: &str, at: Point, before: f32, rotated: bool);
}

const FONT_SIZE: f32 = 14.0;

/// Width of a text in the font of the pictures.
pub fn text_width(text: &str) -> f64 {
    let Ok(font) = Face::parse(dejavu::sans::regular(), 0) else {
        return 0.6 * f64::from(FONT_SIZE) * text.len() as f64;
    };
    let advance = |letter| font.glyph_hor_advance(font.glyph_index(letter).unwrap_or_default()).unwrap_or_default();
    let units: f64 = text.chars().map(|letter| f64::from(advance(letter))).sum();
    units * f64::from(FONT_SIZE) / f64::from(font.units_per_em())
}

/// From the centre of capital letters to their foot.
const DOWN: f32 = 0.36 * FONT_SIZE;

pub struct Svg(String);

impl Svg {
    pub fn new((width, height): (u32, u32)) -> Svg {
        Svg(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        ))
    }

    pub fn finish(self) -> Vec<u8> {
        (self.0 + "</svg>\n").into_bytes()
    }
}

impl Canvas for Svg {
    fn lines(&mut self, lines: &[Vec<Point>], stroke: &Stroke) {
        let Stroke { colour: [red, green, blue], width, dash } = stroke;
        let mut path = String::new();
        for line in lines {
            for (i, (x, y)) in line.iter().enumerate() {
                // Writing to a string succeeds.
                let _ = write!(path, "{}{x:.2} {y:.2}", if i == 0 { 'M' } else { 'L' });
            }
        }
        let ends = match dash {
            Some([dash, gap]) => format!("stroke-dasharray=\"{dash} {gap}\""),
            None => "stroke-linecap=\"round\"".to_owned(),
        };
        self.0.push_str(&format!(
            "<path fill=\"none\" stroke=\"#{red:02x}{green:02x}{blue:02x}\" stroke-width=\"{width}\" \
             stroke-linejoin=\"round\" {ends} d=\"{path}\"/>\n"
        ));
    }

    fn text(&mut self, text: &str, (x, y): Point, before: f32, rotated: bool) {
        let anchor = ["start", "middle", "end"][(2.0 * before) as usize];
        let rotation = if rotated { " rotate(-90)" } else { "" };
        self.0.push_str(&format!(
            "<text font-family=\"DejaVu Sans, sans-serif\" font-size=\"{FONT_SIZE}\" text-anchor=\"{anchor}\" \
             transform=\"translate({x:.2} {y:.2}){rotation}\" y=\"{DOWN}\">{text}</text>\n"
        ));
    }
}

/// Pixels of a bitmap per unit of length.
const RESOLUTION: f32 = 2.0;

pub struct Bitmap {
    pixels: Pixmap,
    font: Face<'static>,
}

impl Bitmap {
    /// `None` if the size is zero, or the built-in font invalid.
    pub fn new((width, height): (u32, u32)) -> Option<Bitmap> {
        let pixels = |size: u32| (size as f32 * RESOLUTION) as u32;
        let mut pixels = Pixmap::new(pixels(width), pixels(height))?;
        pixels.fill(Color::WHITE);
        Some(Bitmap { pixels, font: Face::parse(dejavu::sans::regular(), 0).ok()? })
    }

    /// The file; `None` if it is too large for the format.
    pub fn finish(&self) -> Option<Vec<u8>> {
        self.pixels.encode_png().ok()
    }
}

impl Canvas for Bitmap {
    fn lines(&mut self, lines: &[Vec<Point>], stroke: &Stroke) {
        let Stroke { colour: [red, green, blue], width, dash } = *stroke;
        let mut path = PathBuilder::new();
        for line in lines {
            for (i, &(x, y)) in line.iter().enumerate() {
                let draw = if i == 0 { PathBuilder::move_to } else { PathBuilder::line_to };
                draw(&mut path, x as f32, y as f32);
            }
        }
        let mut paint = Paint::default();
        paint.set_color_rgba8(red, green, blue, 255);
        let line_cap = if dash.is_some() { LineCap::Butt } else { LineCap::Round };
        let dash = dash.and_then(|dash| StrokeDash::new(dash.to_vec(), 0.0));
        let stroke = tiny_skia::Stroke { width, dash, line_cap, line_join: LineJoin::Round, ..Default::default() };
        if let Some(path) = path.finish() {
            self.pixels.stroke_path(&path, &paint, &stroke, Transform::from_scale(RESOLUTION, RESOLUTION), None);
        }
    }

    fn text(&mut self, text: &str, (x, y): Point, before: f32, rotated: bool) {
        let (mut outline, mut width) = (Outline::default(), 0.0);
        for glyph in text.chars().map(|letter| self.font.glyph_index(letter).unwrap_or_default()) {
            outline.start = width;
            self.font.outline_glyph(glyph, &mut outline);
            width += f32::from(self.font.glyph_hor_advance(glyph).unwrap_or_default());
        }
        let scale = FONT_SIZE / f32::from(self.font.units_per_em());
        let transform = Transform::from_translate(-before * width, 0.0)
            .post_scale(scale, -scale)
            .post_translate(0.0, DOWN)
            .post_rotate(if rotated { -90.0 } else { 0.0 })
            .post_translate(x as f32, y as f32)
            .post_scale(RESOLUTION, RESOLUTION);
        if let Some(path) = outline.path.finish() {
            self.pixels.fill_path(&path, &Paint::default(), FillRule::Winding, transform, None);
        }
    }
}

/// Outline of a text in the units of its font.
#[derive(Default)]
struct Outline {
    path: PathBuilder,
    /// Where the present glyph starts.
    start: f32,
}

impl OutlineBuilder for Outline {
    fn move_to(&mut self, x: f32, y: f32) {
        self.path.move_to(self.start + x, y);
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.path.line_to(self.start + x, y);
    }

    fn quad_to(&mut self, x1: f32, y1: f32, x: f32, y: f32) {
        self.path.quad_to(self.start + x1, y1, self.start + x, y);
    }

    fn curve_to(&mut self, x1: f32, y1: f32, x2: f32, y2: f32, x: f32, y: f32) {
        self.path.cubic_to(self.start + x1, y1, self.start + x2, y2, self.start + x, y);
    }

    fn close(&mut self) {
        self.path.close();
    }
}
