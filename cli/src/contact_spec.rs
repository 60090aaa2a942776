//! The contact: defined by a parameter file, by options, or by a file some of whose parameters are overridden by options.

use crate::error::{CliError, Result, input, usage};
use crate::files::{PARAMETERS_SIZE, read_text};
use crate::number::format_list;
use crate::units::{Quantity, Units};
use clap::Args;
use microslip::element::{Directions, Element, NormalInput};
use microslip::{Contact, Error, Layer, Material};
use microslip_fit::{ContactParameters, DisplacementReference, Geometry};
use serde::Deserialize;
use std::ffi::CStr;
use std::path::Path;

/// Parameters of the file or of the options.
#[derive(Debug, Default, Clone, Args, Deserialize)]
#[serde(deny_unknown_fields)]
#[command(next_help_heading = "Contact (each option overrides the parameter file)")]
pub struct ContactArgs {
    /// Half-width a >= 0 of the flat; 0 is a cylinder
    #[arg(long, value_name = "m")]
    pub flat_half_width: Option<f64>,
    /// Radius R > 0 of the rounded edges, or of the cylinder
    #[arg(long, value_name = "m")]
    pub edge_radius: Option<f64>,
    /// Length L > 0 of the contact along its line
    #[arg(long, value_name = "m")]
    pub length: Option<f64>,
    /// Elliptical contact: semi-axis b > 0 along the tangential force
    #[arg(long, value_name = "m")]
    pub semi_axis_x: Option<f64>,
    /// Elliptical contact: semi-axis l > 0 across the tangential force
    #[arg(long, value_name = "m")]
    pub semi_axis_y: Option<f64>,
    /// Normal force N >= 0, total; 0 is an open contact
    #[arg(long, value_name = "N")]
    pub normal_force: Option<f64>,
    /// Coulomb's friction coefficient mu >= 0
    #[arg(long, value_name = "NUMBER")]
    pub friction_coefficient: Option<f64>,
    /// Young's modulus of both bodies, or of each: 200e9,114e9
    #[arg(long, value_name = "Pa")]
    #[serde(skip)]
    young_modulus: Vec<f64>,
    /// Poisson's ratio of both bodies, or of each: 0.3,0.32
    #[arg(long, value_name = "NUMBER")]
    #[serde(skip)]
    poisson_ratio: Vec<f64>,
    /// Layer in series with the contact: compliance c_n >= 0 under the reference load [default: 0, none]
    #[arg(long, value_name = "m/N")]
    normal_compliance: Option<f64>,
    /// Layer: compliance c_t >= 0 along the tangential force, under the reference load [default: 0, none]
    #[arg(long, value_name = "m/N")]
    tangential_compliance: Option<f64>,
    /// Layer: N_c, its stiffness grows in proportion to N + N_c [default: 0, constant stiffness]
    #[arg(long, value_name = "N")]
    pub stiffening_load: Option<f64>,
    /// Layer: the load under which its compliances hold, as measured [default: the normal force]
    #[arg(long, value_name = "N")]
    reference_load: Option<f64>,
    /// Reference of the displacement of a flat: rigid_strip for the contact of a machine
    #[arg(long, value_name = "NAME")]
    displacement_reference: Option<DisplacementReference>,
    /// Units of input and output; must agree with those of a parameter file [default: si]
    #[arg(long, value_name = "NAME")]
    units: Option<Units>,
    #[arg(skip)]
    #[serde(default)]
    material: Vec<MaterialTable>,
}

/// A table `[[material]]`.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialTable {
    young_modulus: Option<f64>,
    poisson_ratio: Option<f64>,
}

/// A contact and the parameters that define it.
#[derive(Debug)]
pub struct ContactSpec {
    pub contact: Contact,
    pub given: ContactArgs,
    pub units: Units,
}

impl ContactSpec {
    /// The contact of the file, if any, and of the options.
    pub fn read(file: Option<&Path>, options: &ContactArgs) -> Result<ContactSpec> {
        let mut given = options.clone();
        if let Some(path) = file {
            given.add(parse(&read_text(path, PARAMETERS_SIZE)?).map_err(|reason| CliError::in_file(path, reason))?)?;
        }
        given.check_presence()?;
        let contact = given.parameters()?.contact().map_err(|error| {
            let (message, parameter) = given.explain(error);
            let others =
                given.implausible().into_iter().filter(|text| parameter.is_none_or(|name| !text.starts_with(name)));
            let message = [message].into_iter().chain(others).collect::<Vec<_>>().join("; ");
            let is_in_file = |name| options.numbers().contains(&(name, Vec::new()));
            match file {
                Some(path) if parameter.is_some_and(is_in_file) => CliError::in_file(path, message),
                _ => CliError::Input(message),
            }
        })?;
        Ok(ContactSpec { contact, units: given.units.unwrap_or(Units::Si), given })
    }

    /// The element of the same contact under a normal force that varies.
    pub fn element(&self, directions: Directions, normal_input: NormalInput) -> Result<Element> {
        self.element_with(self.given.layer(), directions, normal_input)
    }

    /// The element with another layer.
    pub fn element_with(&self, layer: Layer, directions: Directions, normal_input: NormalInput) -> Result<Element> {
        if self.given.normal_force == Some(0.0) {
            return input("without a normal force the contact is open: normal_force must be > 0");
        }
        let element = match self.given.contact()?.parameters(layer) {
            ContactParameters::Flat(parameters) => Element::rounded_flat(&parameters, directions, normal_input),
            ContactParameters::Ellipse(parameters) => Element::elliptic(&parameters, directions, normal_input),
        };
        element.map_err(|error| CliError::Input(self.given.explain(error).0))
    }
}

/// Parses a parameter file.
fn parse(text: &str) -> std::result::Result<ContactArgs, String> {
    let mut file: ContactArgs = toml::from_str(text).map_err(|error| error.to_string().trim_end().to_owned())?;
    if file.material.len() > 2 {
        return Err("a contact has two bodies: at most two tables [[material]]".to_owned());
    }
    let of_each =
        |value: fn(&MaterialTable) -> Option<f64>| file.material.iter().map(value).collect::<Option<Vec<_>>>();
    let young_modulus = of_each(|body| body.young_modulus).unwrap_or_default();
    file.poisson_ratio = of_each(|body| body.poisson_ratio).unwrap_or_default();
    file.young_modulus = young_modulus;
    Ok(file)
}

fn option_name(parameter: &str) -> String {
    format!("--{}", parameter.replace('_', "-"))
}

impl ContactArgs {
    pub fn is_elliptic(&self) -> bool {
        self.semi_axis_x.is_some() || self.semi_axis_y.is_some()
    }

    fn scalars(&mut self) -> [(&'static str, &mut Option<f64>); 11] {
        [
            ("flat_half_width", &mut self.flat_half_width),
            ("edge_radius", &mut self.edge_radius),
            ("length", &mut self.length),
            ("semi_axis_x", &mut self.semi_axis_x),
            ("semi_axis_y", &mut self.semi_axis_y),
            ("normal_force", &mut self.normal_force),
            ("friction_coefficient", &mut self.friction_coefficient),
            ("normal_compliance", &mut self.normal_compliance),
            ("tangential_compliance", &mut self.tangential_compliance),
            ("stiffening_load", &mut self.stiffening_load),
            ("reference_load", &mut self.reference_load),
        ]
    }

    /// Values of the parameters by name: those of a rounded flat (3), of an ellipse (2), common ones, and
    /// those of a layer (4).
    fn numbers(&self) -> Vec<(&'static str, Vec<f64>)> {
        let scalars = self.clone().scalars().map(|(name, value)| (name, Vec::from_iter(*value)));
        let lists = [("young_modulus", self.young_modulus.clone()), ("poisson_ratio", self.poisson_ratio.clone())];
        scalars.into_iter().chain(lists).collect()
    }

    /// Warnings of the library about implausible parameters, with the value of the parameter with which each begins.
    pub fn implausible(&self) -> Vec<String> {
        let units = self.units.unwrap_or(Units::Si);
        let metre = Some(1.0 / units.in_si(Quantity::Length));
        let warnings: Vec<_> = match self.parameters() {
            Ok(ContactParameters::Flat(parameters)) => parameters.warnings(metre).collect(),
            Ok(ContactParameters::Ellipse(parameters)) => parameters.warnings(metre).collect(),
            Err(_) => Vec::new(),
        };
        let with_value = |text: &CStr| {
            let text = text.to_string_lossy();
            let name = text.split(' ').next()?;
            let (_, values) = self.numbers().into_iter().find(|(known, _)| *known == name)?;
            let unit = match name {
                "friction_coefficient" => String::new(),
                "young_modulus" => format!(" {}", units.unit(Quantity::Pressure)),
                "normal_force" => format!(" {}", units.unit(Quantity::Force)),
                _ => format!(" {}", units.unit(Quantity::Length)),
            };
            Some(format!("{name} = {}{unit}{}", format_list(&values), &text[name.len()..]))
        };
        warnings.into_iter().filter_map(with_value).collect()
    }

    /// Adds the parameters of the file that are not given yet.
    fn add(&mut self, mut file: ContactArgs) -> Result<()> {
        if self.units.zip(file.units).is_some_and(|(option, file)| option != file) {
            return input("--units differs from the units of the parameter file; numbers are not converted");
        }
        for ((_, to), (_, value)) in self.scalars().into_iter().zip(file.scalars()) {
            *to = to.or(*value);
        }
        let lists = [(&mut self.young_modulus, file.young_modulus), (&mut self.poisson_ratio, file.poisson_ratio)];
        for (to, values) in lists.into_iter().filter(|(to, _)| to.is_empty()) {
            *to = values;
        }
        self.displacement_reference = self.displacement_reference.or(file.displacement_reference);
        self.units = self.units.or(file.units);
        Ok(())
    }

    /// Checks that the parameters of exactly one shape are given.
    fn check_presence(&self) -> Result<()> {
        let numbers = self.numbers();
        let is_given = |name: &str| match name {
            "displacement_reference" => self.displacement_reference.is_some(),
            name => numbers.iter().any(|(given, values)| *given == name && !values.is_empty()),
        };
        let names = microslip_fit::missing_parameters(is_given).map_err(|error| CliError::Input(error.to_string()))?;
        if names.is_empty() {
            return Ok(());
        }
        let options = names.iter().map(|name| option_name(name)).collect::<Vec<_>>().join(", ");
        let why = if names.contains(&"displacement_reference") {
            "; displacement_reference is rigid_strip for the contact of a machine, centre_point as in the paper"
        } else {
            ""
        };
        usage(format!("missing parameters: {}; give them in a parameter file or by {options}{why}", names.join(", ")))
    }

    /// The contact without its layer.
    pub fn contact(&self) -> Result<microslip_fit::Contact> {
        let of_both = |values: &[f64]| match *values {
            [both] => Ok([both; 2]),
            [first, second] => Ok([first, second]),
            _ => usage("a contact has two bodies: give one number for both, or two"),
        };
        let [young_modulus, poisson_ratio] = [of_both(&self.young_modulus)?, of_both(&self.poisson_ratio)?];
        let material = [0, 1].map(|i| Material { young_modulus: young_modulus[i], poisson_ratio: poisson_ratio[i] });
        // Missing numbers were reported; the library rejects NaN.
        let number = |value: Option<f64>| value.unwrap_or(f64::NAN);
        let [normal_force, friction_coefficient] = [self.normal_force, self.friction_coefficient].map(number);
        let geometry = if self.is_elliptic() {
            let [semi_axis_x, semi_axis_y] = [self.semi_axis_x, self.semi_axis_y].map(number);
            Geometry::Ellipse { semi_axis_x, semi_axis_y }
        } else {
            Geometry::Flat {
                flat_half_width: number(self.flat_half_width),
                edge_radius: number(self.edge_radius),
                length: number(self.length),
                displacement_reference: self.displacement_reference.unwrap_or(DisplacementReference::RigidStrip),
            }
        };
        Ok(microslip_fit::Contact { geometry, normal_force, friction_coefficient, material })
    }

    fn layer(&self) -> Layer {
        let number = |value: Option<f64>| value.unwrap_or(0.0);
        Layer {
            normal_compliance: number(self.normal_compliance),
            tangential_compliance: number(self.tangential_compliance),
            stiffening_load: number(self.stiffening_load),
            reference_load: number(self.reference_load),
        }
    }

    fn parameters(&self) -> Result<ContactParameters> {
        Ok(self.contact()?.parameters(self.layer()))
    }

    /// Tangential over normal compliance of a rough surface: (2-ν)/(2(1-ν)), the mean of both bodies by their shares of 1/E*.
    pub fn tangential_ratio(&self) -> Result<f64> {
        let [first, second] = self.contact()?.material.map(|Material { young_modulus, poisson_ratio: nu }| {
            ((1.0 - nu * nu) / young_modulus, 0.5 * (2.0 - nu) / (1.0 - nu))
        });
        Ok((first.0 * first.1 + second.0 * second.1) / (first.0 + second.0))
    }

    /// The message of an error, with the values of the parameter that it names first, and the name of that parameter.
    fn explain(&self, error: Error) -> (String, Option<&'static str>) {
        let message = error.to_string();
        let numbers = self.numbers();
        let given = |word: &str| numbers.iter().find(|(name, values)| word == *name && !values.is_empty());
        let subject = message.split(' ').find_map(given);
        let Some((name, values)) = subject else { return (message, None) };
        (format!("{message}, not {}", format_list(values)), Some(name))
    }

    /// The options that define the same contact.
    pub fn options(&self) -> String {
        let numbers = self.numbers().into_iter().filter(|(_, values)| !values.is_empty());
        let mut options: String =
            numbers.map(|(name, values)| format!(" {} {}", option_name(name), format_list(&values))).collect();
        options.push_str(match self.displacement_reference {
            Some(DisplacementReference::RigidStrip) => " --displacement-reference rigid_strip",
            Some(DisplacementReference::CentrePoint) => " --displacement-reference centre_point",
            None => "",
        });
        if self.units == Some(Units::Mm) {
            options.push_str(" --units mm");
        }
        options
    }
}
