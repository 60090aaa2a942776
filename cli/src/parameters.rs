//! The contact a user describes: by a parameter file, by flags, or by a file of which flags change something.

use crate::digits::{digits, list};
use crate::refusal::{Outcome, Refusal, input, usage};
use crate::units::Units;
use clap::{Args, ValueEnum};
use microslip::parameters::{CENTRE_POINT, RIGID_STRIP};
use microslip::{Contact, EllipticParameters, Error, Material, Parameters};
use serde::Deserialize;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// What a file or the flags give.
#[derive(Debug, Default, Args, Deserialize)]
#[command(next_help_heading = "Contact (each overrides the parameter file)")]
pub struct Given {
    /// Half-width a >= 0 of the flat; 0 is a cylinder
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    flat_half_width: Option<f64>,
    /// Radius R > 0 of the rounded edges, or of the cylinder
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    edge_radius: Option<f64>,
    /// Length L > 0 of the contact along its line
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    length: Option<f64>,
    /// Elliptical contact: semi-axis b > 0 along the tangential force
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    semi_axis_x: Option<f64>,
    /// Elliptical contact: semi-axis l > 0 across the tangential force
    #[arg(long, value_name = "m", allow_hyphen_values = true)]
    semi_axis_y: Option<f64>,
    /// Normal force N >= 0 on the whole contact; 0 is an open contact
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    normal_force: Option<f64>,
    /// Coulomb's friction coefficient mu >= 0
    #[arg(long, value_name = "NUMBER", allow_hyphen_values = true)]
    friction_coefficient: Option<f64>,
    /// Young's modulus of both bodies, or of each: 200e9,114e9
    #[arg(long, value_name = "Pa", value_delimiter = ',', allow_hyphen_values = true)]
    #[serde(skip)]
    young_modulus: Vec<f64>,
    /// Poisson's ratio of both bodies, or of each: 0.3,0.32
    #[arg(long, value_name = "NUMBER", value_delimiter = ',', allow_hyphen_values = true)]
    #[serde(skip)]
    poisson_ratio: Vec<f64>,
    /// Where the displacement is taken [default: centre_point]
    #[arg(long, value_name = "NAME")]
    displacement_reference: Option<Reference>,
    /// Units of all numbers, given and computed; a parameter file must not name others [default: si]
    #[arg(long, value_name = "NAME")]
    units: Option<Units>,
    #[arg(skip)]
    #[serde(default)]
    material: Vec<GivenMaterial>,
}

#[derive(Debug, Clone, Copy, Deserialize)]
struct GivenMaterial {
    young_modulus: Option<f64>,
    poisson_ratio: Option<f64>,
}

#[derive(Debug, Clone, Copy, ValueEnum, Deserialize)]
#[serde(rename_all = "snake_case")]
#[value(rename_all = "snake_case")]
enum Reference {
    /// The centre of the contact, under a line of uniform traction
    CentrePoint,
    /// A rigid strip, corrected to three-dimensional contact mechanics
    RigidStrip,
}

/// Names that a parameter file may use, outside and inside of `[[material]]`.
const KEYS: [&str; 10] = [
    "flat_half_width",
    "edge_radius",
    "length",
    "semi_axis_x",
    "semi_axis_y",
    "normal_force",
    "friction_coefficient",
    "displacement_reference",
    "units",
    "material",
];
const MATERIAL_KEYS: [&str; 2] = ["young_modulus", "poisson_ratio"];

/// A contact with the numbers it was made from.
#[derive(Debug)]
pub struct Described {
    pub contact: Contact,
    pub units: Units,
    pub shape: Shape,
}

#[derive(Debug, Clone, Copy)]
pub enum Shape {
    RoundedFlat(Parameters),
    Elliptic(EllipticParameters),
}

/// Prepares the contact that the file and the flags describe.
pub fn describe(file: Option<&Path>, flags: &Given) -> Outcome<Described> {
    let from_file = file.map_or(Ok(Given::default()), read_file)?;
    let given = flags.or(&from_file)?;
    let shape = given.shape()?;
    let contact = match &shape {
        Shape::RoundedFlat(parameters) => Contact::rounded_flat(parameters),
        Shape::Elliptic(parameters) => Contact::elliptic(parameters),
    };
    let contact = contact.map_err(|error| flags.blame(error, file))?;
    Ok(Described { contact, units: given.units.unwrap_or(Units::Si), shape })
}

fn read_file(path: &Path) -> Outcome<Given> {
    let text = if path == Path::new("-") {
        let mut text = String::new();
        io::stdin().read_to_string(&mut text).map(|_| text)
    } else {
        fs::read_to_string(path)
    };
    parse(&text.map_err(|error| Refusal::in_file(path, error))?).map_err(|reason| Refusal::in_file(path, reason))
}

/// What a parameter file says, or what is wrong with it.
fn parse(text: &str) -> Result<Given, String> {
    let mut unknown = None;
    let document = toml::Deserializer::parse(text).map_err(|error| error.to_string())?;
    let given: Given = serde_ignored::deserialize(document, |path| {
        unknown.get_or_insert_with(|| path.to_string());
    })
    .map_err(|error: toml::de::Error| error.to_string())?;
    if let Some(path) = unknown {
        let (inside, key) = path.rsplit_once('.').unwrap_or(("", &path));
        let keys = if inside.is_empty() { &KEYS[..] } else { &MATERIAL_KEYS[..] };
        return Err(format!("unknown key {key}; {}", nearest(key, keys)));
    }
    if given.material.len() > 2 {
        return Err("a contact has two bodies: at most two tables [[material]]".to_owned());
    }
    Ok(given)
}

/// The key that was meant, or all keys where none is near.
fn nearest(key: &str, keys: &[&str]) -> String {
    let elsewhere = KEYS.iter().chain(&MATERIAL_KEYS).find(|known| **known == key && !keys.contains(known));
    if let Some(known) = elsewhere {
        let place = if MATERIAL_KEYS.contains(known) { "inside" } else { "outside" };
        return format!("it belongs {place} of [[material]]");
    }
    let likeness = |known: &&&str| strsim::jaro_winkler(key, known);
    match keys.iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b))) {
        // Below this likeness, names share hardly more than some letters.
        Some(known) if likeness(&known) > 0.75 => format!("did you mean {known}?"),
        _ => format!("keys are {}", keys.join(", ")),
    }
}

impl Given {
    /// These, and for what is not among them those of the file.
    fn or(&self, file: &Given) -> Outcome<Given> {
        let mut material = match file.material[..] {
            [] => [GivenMaterial { young_modulus: None, poisson_ratio: None }; 2],
            [both] => [both; 2],
            [first, second, ..] => [first, second],
        };
        let [first, second] = &mut material;
        for (values, to) in [
            (&self.young_modulus, [&mut first.young_modulus, &mut second.young_modulus]),
            (&self.poisson_ratio, [&mut first.poisson_ratio, &mut second.poisson_ratio]),
        ] {
            let values = match values[..] {
                [] => continue,
                [both] => [both; 2],
                [first, second] => [first, second],
                _ => return usage("a contact has two bodies: give one number for both, or two"),
            };
            to.into_iter().zip(values).for_each(|(to, value)| *to = Some(value));
        }
        // Nothing is converted: the file's numbers would be taken for others.
        if self.units.zip(file.units).is_some_and(|(asked, written)| asked != written) {
            return input("--units: the parameter file names other units, and its numbers would not be converted");
        }
        Ok(Given {
            flat_half_width: self.flat_half_width.or(file.flat_half_width),
            edge_radius: self.edge_radius.or(file.edge_radius),
            length: self.length.or(file.length),
            semi_axis_x: self.semi_axis_x.or(file.semi_axis_x),
            semi_axis_y: self.semi_axis_y.or(file.semi_axis_y),
            normal_force: self.normal_force.or(file.normal_force),
            friction_coefficient: self.friction_coefficient.or(file.friction_coefficient),
            displacement_reference: self.displacement_reference.or(file.displacement_reference),
            units: self.units.or(file.units),
            material: material.to_vec(),
            ..Given::default()
        })
    }

    /// The single numbers, by their names.
    fn numbers(&self) -> [(&'static str, Option<f64>); 7] {
        [
            ("flat_half_width", self.flat_half_width),
            ("edge_radius", self.edge_radius),
            ("length", self.length),
            ("semi_axis_x", self.semi_axis_x),
            ("semi_axis_y", self.semi_axis_y),
            ("normal_force", self.normal_force),
            ("friction_coefficient", self.friction_coefficient),
        ]
    }

    /// The library's parameters, when all are there.
    fn shape(&self) -> Outcome<Shape> {
        let [flat_half_width, edge_radius, length, semi_axis_x, semi_axis_y, normal_force, friction_coefficient] =
            self.numbers();
        let rounded_flat = [flat_half_width, edge_radius, length];
        let elliptic = [semi_axis_x, semi_axis_y];
        let given = |numbers: &[(&str, Option<f64>)]| numbers.iter().any(|(_, value)| value.is_some());
        let is_elliptic = given(&elliptic);
        if is_elliptic && (given(&rounded_flat) || self.displacement_reference.is_some()) {
            return input(
                "a contact is either elliptical, by semi_axis_x and semi_axis_y, or a rounded flat, by flat_half_width, \
                 edge_radius, length and displacement_reference; here are some of both",
            );
        }
        let of_both =
            |number: fn(&GivenMaterial) -> Option<f64>| self.material.iter().map(number).reduce(Option::and).flatten();
        let common = [
            normal_force,
            friction_coefficient,
            ("young_modulus", of_both(|body| body.young_modulus)),
            ("poisson_ratio", of_both(|body| body.poisson_ratio)),
        ];
        let geometry = if is_elliptic { &elliptic[..] } else { &rounded_flat };
        let missing = geometry.iter().chain(&common).filter(|(_, value)| value.is_none()).map(|(name, _)| *name);
        refuse_missing(&missing.collect::<Vec<_>>())?;

        // The library refuses a number that is none by its name.
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let body = |i: usize| Material {
            young_modulus: number(self.material[i].young_modulus),
            poisson_ratio: number(self.material[i].poisson_ratio),
        };
        let material = [body(0), body(1)];
        let (normal_force, friction_coefficient) = (number(self.normal_force), number(self.friction_coefficient));
        if is_elliptic {
            let (semi_axis_x, semi_axis_y) = (number(self.semi_axis_x), number(self.semi_axis_y));
            return Ok(Shape::Elliptic(EllipticParameters {
                semi_axis_x,
                semi_axis_y,
                normal_force,
                friction_coefficient,
                material,
            }));
        }
        Ok(Shape::RoundedFlat(Parameters {
            flat_half_width: number(self.flat_half_width),
            edge_radius: number(self.edge_radius),
            length: number(self.length),
            normal_force,
            friction_coefficient,
            material,
            displacement_reference: match self.displacement_reference {
                Some(Reference::RigidStrip) => RIGID_STRIP,
                Some(Reference::CentrePoint) | None => CENTRE_POINT,
            },
            ..Parameters::default()
        }))
    }

    /// The library's message, after the flag or the file of the parameter that it names.
    fn blame(&self, error: Error, file: Option<&Path>) -> Refusal {
        let message = error.to_string();
        let is_named = |name: &str| message.split(' ').any(|word| word == name);
        let mut flags: Vec<_> = self.numbers().map(|(name, value)| (name, Vec::from_iter(value))).into();
        flags.extend([("young_modulus", self.young_modulus.clone()), ("poisson_ratio", self.poisson_ratio.clone())]);
        match (flags.iter().find(|(name, values)| is_named(name) && !values.is_empty()), file) {
            (Some((name, values)), _) => Refusal::of_flag(&flag(name), list(values), error),
            (None, Some(path)) => Refusal::in_file(path, error),
            (None, None) => Refusal::Input(message),
        }
    }
}

fn refuse_missing(names: &[&str]) -> Outcome<()> {
    let [noun, pronoun] = match names.len() {
        0 => return Ok(()),
        1 => ["a number is", "it"],
        _ => ["numbers are", "them"],
    };
    let flags: Vec<_> = names.iter().map(|name| flag(name)).collect();
    let (names, flags) = (names.join(", "), flags.join(", "));
    usage(format!("{noun} missing: {names}; give {pronoun} in a parameter file or by {flags}"))
}

fn flag(name: &str) -> String {
    format!("--{}", name.replace('_', "-"))
}

impl Described {
    /// The flags that describe the same contact.
    pub fn flags(&self) -> String {
        let mut flags = String::new();
        let mut add = |name: &str, value: String| flags.push_str(&format!(" {} {value}", flag(name)));
        let (normal_force, friction_coefficient, material) = match self.shape {
            Shape::RoundedFlat(p) => {
                add("flat_half_width", digits(p.flat_half_width));
                add("edge_radius", digits(p.edge_radius));
                add("length", digits(p.length));
                if p.displacement_reference == RIGID_STRIP {
                    add("displacement_reference", "rigid_strip".to_owned());
                }
                (p.normal_force, p.friction_coefficient, p.material)
            }
            Shape::Elliptic(p) => {
                add("semi_axis_x", digits(p.semi_axis_x));
                add("semi_axis_y", digits(p.semi_axis_y));
                (p.normal_force, p.friction_coefficient, p.material)
            }
        };
        add("normal_force", digits(normal_force));
        add("friction_coefficient", digits(friction_coefficient));
        add("young_modulus", list(&material.map(|body| body.young_modulus)));
        add("poisson_ratio", list(&material.map(|body| body.poisson_ratio)));
        if self.units == Units::Mm {
            add("units", "mm".to_owned());
        }
        flags
    }
}
