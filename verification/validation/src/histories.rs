//! Histories that the boundary-element code CONTACT computed, in `tests/golden/contact_code`, and their contacts. Files are in mm, N,
//! MPa and mJ; here everything is in SI units.

use microslip::element::{Directions, Element, NormalInput};
use microslip::{EllipticParameters, Error, Material, Parameters};

/// The contacts of the files.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    Cylinder,
    RoundedFlat,
    Sphere,
}

/// A row: forces, and what CONTACT found: displacement and energy dissipated so far.
#[derive(Debug, Clone, Copy)]
pub struct Row {
    pub normal_force: f64,
    pub tangential_force: f64,
    pub displacement: f64,
    pub dissipated: f64,
    /// Normal approach of the line contacts; NaN for the sphere.
    pub approach: f64,
}

pub struct History {
    pub shape: Shape,
    /// Name of the file: shape and path.
    pub name: &'static str,
    pub rows: Vec<Row>,
}

macro_rules! files {
    ($($shape:ident $name:literal)*) => {
        [$((Shape::$shape, $name, include_str!(concat!("../../../tests/golden/contact_code/", $name, ".csv")))),*]
    };
}

/// All histories.
pub fn all() -> Vec<History> {
    let files = files!(
        Cylinder "cylinder_constN" Cylinder "cylinder_steps" Cylinder "cylinder_phase0" Cylinder "cylinder_phase90"
        Cylinder "cylinder_phase180"
        RoundedFlat "roundedflat_constN" RoundedFlat "roundedflat_steps" RoundedFlat "roundedflat_phase0"
        RoundedFlat "roundedflat_phase90" RoundedFlat "roundedflat_phase180"
        Sphere "sphere_constN" Sphere "sphere_steps" Sphere "sphere_phase0" Sphere "sphere_phase90" Sphere "sphere_phase180"
    );
    files.into_iter().map(|(shape, name, text)| History { shape, name, rows: rows(shape, text) }).collect()
}

/// The head is a comment that ends with the names of the columns.
fn rows(shape: Shape, text: &str) -> Vec<Row> {
    let row = |line: &str| {
        let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().expect("a number")).collect();
        let [_, normal_force, tangential_force, displacement, dissipated, approach, ..] = cells[..] else {
            panic!("{line}: columns")
        };
        let approach = if shape == Shape::Sphere { f64::NAN } else { 1e-3 * approach };
        let (displacement, dissipated) = (1e-3 * displacement, 1e-3 * dissipated);
        Row { normal_force, tangential_force, displacement, dissipated, approach }
    };
    text.lines().filter(|line| !line.starts_with('#')).map(row).collect()
}

impl Shape {
    pub fn friction_coefficient(self) -> f64 {
        match self {
            Shape::Cylinder => 0.3,
            Shape::RoundedFlat => 0.5,
            Shape::Sphere => 0.4,
        }
    }

    fn material(self) -> Material {
        let (shear_modulus, poisson_ratio) = match self {
            Shape::Cylinder => (82e9, 0.28),
            Shape::RoundedFlat => (76.9231e9, 0.3),
            Shape::Sphere => (200e6, 0.42),
        };
        Material { young_modulus: 2.0 * (1.0 + poisson_ratio) * shear_modulus, poisson_ratio }
    }

    fn line(self, normal_force: f64) -> Parameters {
        let (flat_half_width, edge_radius, length) = match self {
            Shape::RoundedFlat => (0.5e-3, 3e-3, 20e-3),
            _ => (0.0, 0.5, 0.2),
        };
        Parameters {
            flat_half_width,
            edge_radius,
            length,
            normal_force,
            friction_coefficient: self.friction_coefficient(),
            material: [self.material(); 2],
            displacement_reference: microslip::parameters::CENTRE_POINT,
            ..Parameters::default()
        }
    }

    /// A sphere of radius 50 mm by its contact circle (Hertz).
    fn sphere(self, normal_force: f64) -> EllipticParameters {
        let Material { young_modulus, poisson_ratio } = self.material();
        let modulus = young_modulus / (2.0 * (1.0 - poisson_ratio * poisson_ratio));
        let radius = (3.0 * normal_force * 0.05 / (4.0 * modulus)).cbrt();
        EllipticParameters {
            semi_axis_x: radius,
            semi_axis_y: radius,
            normal_force,
            friction_coefficient: self.friction_coefficient(),
            material: [self.material(); 2],
            ..EllipticParameters::default()
        }
    }

    /// The element, its tables up to a normal force, with the normal force as its input.
    pub fn element(self, normal_force: f64) -> Result<Element, Error> {
        match self {
            Shape::Sphere => Element::elliptic(&self.sphere(normal_force), Directions::One, NormalInput::Force),
            _ => Element::rounded_flat(&self.line(normal_force), Directions::One, NormalInput::Force),
        }
    }
}
