//! Drawing of lines and text, as SVG. A PNG is a rendering of it, in the font that comes with the program.

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree};
use std::fmt::Write;
use std::sync::LazyLock;

pub type Point = (f64, f64);

#[derive(Debug, Clone, Copy)]
pub struct Stroke {
    pub colour: [u8; 3],
    pub width: f32,
    /// Lengths of dash and gap.
    pub dash: Option<[f32; 2]>,
}

const FONT_SIZE: f32 = 14.0;
/// From the centre of capital letters to their foot.
const DOWN: f32 = 0.36 * FONT_SIZE;
/// Pixels of a bitmap per unit of length.
const RESOLUTION: f32 = 2.0;

/// The content of an SVG file, whose texts have the font of the pictures. `None` if the font or the text is invalid.
pub fn parsed(svg: &str) -> Option<Tree> {
    static OPTIONS: LazyLock<Options> = LazyLock::new(|| {
        let mut options = Options::default();
        options.fontdb_mut().load_font_data(dejavu::sans::regular().to_vec());
        options
    });
    Tree::from_str(svg, &OPTIONS).ok()
}

/// Width of a text in the font of the pictures.
pub fn text_width(text: &str) -> f64 {
    let mut svg = Svg::new((1, 1));
    svg.text(text, (0.0, 0.0), 0.0, false);
    parsed(&svg.finish()).map_or(0.0, |tree| tree.root().bounding_box().width().into())
}

/// A PNG file; `None` if it is too large for the format.
pub fn png(svg: &str) -> Option<Vec<u8>> {
    let tree = parsed(svg)?;
    let size = tree.size().to_int_size().scale_by(RESOLUTION)?;
    let mut pixels = Pixmap::new(size.width(), size.height())?;
    resvg::render(&tree, Transform::from_scale(RESOLUTION, RESOLUTION), &mut pixels.as_mut());
    pixels.encode_png().ok()
}

/// A drawing area; y points downwards from the upper edge.
pub struct Svg(String);

impl Svg {
    pub fn new((width, height): (u32, u32)) -> Svg {
        Svg(format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" viewBox=\"0 0 {width} {height}\">\n\
             <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n"
        ))
    }

    /// The content of the file.
    pub fn finish(self) -> String {
        self.0 + "</svg>\n"
    }

    /// Draws polylines of one stroke.
    pub fn lines(&mut self, lines: &[Vec<Point>], stroke: &Stroke) {
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

    /// Draws black text, vertically centred at the point, with the fraction `before` of its width before it. Rotated text
    /// runs upwards.
    pub fn text(&mut self, text: &str, (x, y): Point, before: f32, rotated: bool) {
        let anchor = ["start", "middle", "end"][(2.0 * before) as usize];
        let rotation = if rotated { " rotate(-90)" } else { "" };
        self.0.push_str(&format!(
            "<text font-family=\"DejaVu Sans, sans-serif\" font-size=\"{FONT_SIZE}\" text-anchor=\"{anchor}\" \
             transform=\"translate({x:.2} {y:.2}){rotation}\" y=\"{DOWN}\">{text}</text>\n"
        ));
    }
}
