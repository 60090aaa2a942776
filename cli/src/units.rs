//! Units. The friction law holds in any consistent set of units: only pictures convert.

use clap::ValueEnum;
use serde::Deserialize;

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Units {
    /// m, N, Pa, N/m, J
    Si,
    /// mm, N, MPa, N/mm, mJ
    Mm,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Quantity {
    Number,
    Angle,
    Length,
    Force,
    /// Pressures and moduli.
    Pressure,
    /// Stiffness, and the damage parameter.
    Stiffness,
    StiffnessSlope,
    Energy,
}

impl Units {
    /// The unit of a quantity, and its value in SI units.
    fn unit_and_factor(self, quantity: Quantity) -> (&'static str, f64) {
        let (si, mm, factor) = match quantity {
            Quantity::Number => ("-", "-", 1.0),
            Quantity::Angle => ("deg", "deg", 1.0),
            Quantity::Length => ("m", "mm", 1e-3),
            Quantity::Force => ("N", "N", 1.0),
            Quantity::Pressure => ("Pa", "MPa", 1e6),
            Quantity::Stiffness => ("N/m", "N/mm", 1e3),
            Quantity::StiffnessSlope => ("N/m^2", "N/mm^2", 1e6),
            Quantity::Energy => ("J", "mJ", 1e-3),
        };
        if self == Units::Si { (si, 1.0) } else { (mm, factor) }
    }

    pub fn unit(self, quantity: Quantity) -> &'static str {
        self.unit_and_factor(quantity).0
    }

    pub fn in_si(self, quantity: Quantity) -> f64 {
        self.unit_and_factor(quantity).1
    }

    /// The same units of measured data.
    pub fn of_data(self) -> DataUnits {
        DataUnits { length: LENGTHS[usize::from(self == Units::Mm)], force: FORCES[0] }
    }
}

/// Units of measured displacements and forces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DataUnits {
    /// Name and value in SI units.
    length: (&'static str, f64),
    force: (&'static str, f64),
}

const LENGTHS: [(&str, f64); 4] = [("m", 1.0), ("mm", 1e-3), ("um", 1e-6), ("nm", 1e-9)];
const FORCES: [(&str, f64); 3] = [("N", 1.0), ("mN", 1e-3), ("kN", 1e3)];

impl DataUnits {
    /// Two units: `um,N`.
    pub fn parse(text: &str) -> Result<DataUnits, &'static str> {
        let find = |units: &[(&'static str, f64)], name: &str| units.iter().copied().find(|unit| unit.0 == name.trim());
        let text = text.replace(['µ', 'μ'], "u");
        let (length, force) = text.split_once(',').ok_or("two units are needed, for example um,N")?;
        Ok(DataUnits {
            length: find(&LENGTHS, length).ok_or("the displacement is in m, mm, um or nm")?,
            force: find(&FORCES, force).ok_or("the force is in N, mN or kN")?,
        })
    }

    /// Names of both units, and the factors that convert to others.
    pub fn to(self, units: Units) -> [(&'static str, f64); 2] {
        let convert = |(name, value): (&'static str, f64), quantity| (name, value / units.in_si(quantity));
        [convert(self.length, Quantity::Length), convert(self.force, Quantity::Force)]
    }
}

impl std::fmt::Display for DataUnits {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{},{}", self.length.0, self.force.0)
    }
}
